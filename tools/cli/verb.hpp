#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/cli/arguments.hpp"
#include "tools/cli/session.hpp"

namespace sandhopper::cli {

using Run = std::function<ExitCode(Session&)>;

// One command of `hop`. `set_up` adds the verb's options and returns the function to run after parsing.
// --json and --config are added for every verb. tools/cli/README.md shows a complete verb.
struct Verb {
  std::string name;
  std::string summary;  // one line for `hop --help`
  std::function<Run(Arguments&)> set_up;
};

// Every verb of verbs.cmake in alphabetical order, without `set_up`: each verb is a program of its own.
std::vector<Verb> all_verbs();

// Registers a verb; define one constant of this type in verb_NAME.cpp, which belongs to the program hop-NAME.
class VerbRegistration {
 public:
  VerbRegistration(std::string name, std::function<Run(Arguments&)> set_up);
};

// The verb of this program, with its summary. Throws std::logic_error if verbs.cmake does not list it.
Verb verb_of_this_program();

}  // namespace sandhopper::cli
