#pragma once
#include <string>

#include "tools/cli/failure.hpp"
#include "tools/cli/session.hpp"

namespace sandhopper::cli {

// `hop campaign keys PLANT`: prints channels, kinds of trial, and the keys of nominal.toml with unit, default
// and meaning.
ExitCode print_campaign_keys(Session& session, const std::string& plant, bool every_key);

}  // namespace sandhopper::cli
