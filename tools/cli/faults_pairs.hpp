#pragma once
#include <string>

#include "tools/cli/failure.hpp"
#include "tools/cli/session.hpp"
#include "tools/faults/run_cell.hpp"

namespace sandhopper::cli {

struct PairOptions {
  std::string only;  // text that the pair's name must contain
  int sample = 0;    // number of pairs to draw; 0: all
  std::uint64_t seed = 1;
};

// `hop faults --pairs`: runs pairs of faults, prints the wrong ones and a table of all.
ExitCode run_pairs(Session& session, const faults::MatrixSetup& setup, const PairOptions& options);

}  // namespace sandhopper::cli
