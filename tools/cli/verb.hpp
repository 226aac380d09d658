#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/cli/arguments.hpp"
#include "tools/cli/session.hpp"

namespace sandhopper::cli {

using Run = std::function<ExitCode(Session&)>;

// One thing `hop` can do. `set_up` adds the verb's options to its own command line and returns what to run
// once they are read; --json and --config are there already. tools/cli/README.md shows a whole verb.
struct Verb {
  std::string name;
  std::string summary;  // one line for `hop --help`
  std::function<Run(Arguments&)> set_up;
};

// Every verb of verbs.cmake in alphabetical order, without `set_up`: each is a program of its own.
std::vector<Verb> all_verbs();

// A constant of this type in verb_NAME.cpp makes the verb known to its program, hop-NAME.
class VerbRegistration {
 public:
  VerbRegistration(std::string name, std::function<Run(Arguments&)> set_up);
};

// The verb of this program, with its summary. Throws std::logic_error if verbs.cmake does not list it.
Verb verb_of_this_program();

}  // namespace sandhopper::cli
