#pragma once
#include "firmware/log/trial_sheet.hpp"
#include "tools/cli/session.hpp"
#include "tools/cli/trial_options.hpp"

namespace sandhopper::cli {

// Whether somebody sits at a terminal who can be asked.
bool can_ask(const Session& session);

// The trial sheet from --sheet and the options, which go before the file; empty where none was asked for.
// What is missing is asked for at a terminal, else it is a Failure that names the options.
std::optional<TrialSheet> gather_sheet(Session& session, const TrialOptions& options);

// Between the trials of a series: what to do to the bed and the robot, the release height and notes of the
// next trial. False: the operator ends the series.
bool prepare_next(Session& session, int number, int trials, TrialSheet& sheet);

}  // namespace sandhopper::cli
