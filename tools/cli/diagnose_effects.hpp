#pragma once
#include "tools/cli/session.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::cli {

// Lists every effect that a diagnosis of this plant looks for, from the effects' own descriptions: port,
// sentence, equation, parameters with their units, and their typical sizes and ranges in this campaign. An
// effect that these recordings cannot show has no parameters.
ExitCode list_effects(Session& session, const diagnose::Recordings& recordings);

}  // namespace sandhopper::cli
