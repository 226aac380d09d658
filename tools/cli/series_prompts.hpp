#pragma once
#include "firmware/log/trial_sheet.hpp"
#include "tools/cli/session.hpp"
#include "tools/cli/trial_options.hpp"

namespace sandhopper::cli {

// True if a user at a terminal can be asked.
bool can_ask(const Session& session);

// Trial sheet from --sheet and the options, which override the file; empty if neither was given. Missing keys
// are asked for at a terminal; without a terminal a Failure names the options.
std::optional<TrialSheet> gather_sheet(Session& session, const TrialOptions& options);

// Before each trial of a series: tells the operator how to prepare bed and robot, and asks for release height
// and notes. Returns false if the operator ends the series.
bool prepare_next(Session& session, int number, int trials, TrialSheet& sheet);

}  // namespace sandhopper::cli
