#pragma once
#include <vector>

#include "tools/cli/verb.hpp"

namespace sandhopper::cli {

// The whole of a program: reads the command line, runs the verb it names, and turns what went wrong into a
// message, a cure and an exit status.
int run_program(const std::vector<Verb>& verbs, int argc, char** argv);

}  // namespace sandhopper::cli
