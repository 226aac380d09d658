#include "tools/cli/program.hpp"

// Main function of hop-NAME. It gets the command line of `hop`: options of every verb, NAME, its own options.
int main(int argc, char** argv) {
  return sandhopper::cli::run_program({sandhopper::cli::verb_of_this_program()}, argc, argv);
}
