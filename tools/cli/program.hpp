#pragma once
#include <vector>

#include "tools/cli/verb.hpp"

namespace sandhopper::cli {

// Main function of a program: parses the command line, runs the verb, and turns an error into message, cure
// and exit status.
int run_program(const std::vector<Verb>& verbs, int argc, char** argv);

}  // namespace sandhopper::cli
