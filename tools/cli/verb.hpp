#pragma once
#include <CLI/App.hpp>
#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "tools/cli/session.hpp"

namespace sandhopper::cli {

using Run = std::function<ExitCode(Session&)>;

// One thing `hop` can do. `set_up` adds the verb's options to its own parser and returns what to run once
// they are read; --json and --config are there already. tools/cli/README.md shows a whole verb.
struct Verb {
  std::string name;
  std::string summary;  // one line for `hop --help`
  std::function<Run(CLI::App&)> set_up;
};

// A constant of this type in a verb's file makes the verb known.
class VerbRegistration {
 public:
  explicit VerbRegistration(Verb verb);
};

// In alphabetical order.
std::vector<Verb> known_verbs();

}  // namespace sandhopper::cli
