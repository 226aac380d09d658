#include "tools/cli/program.hpp"

// The start of hop-NAME. Its command line is the one `hop` was given: options of every verb, NAME, its own
// options.
int main(int argc, char** argv) {
  return sandhopper::cli::run_program({sandhopper::cli::verb_of_this_program()}, argc, argv);
}
