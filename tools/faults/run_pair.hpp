#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/faults/pair.hpp"
#include "tools/faults/run_cell.hpp"

namespace sandhopper::faults {

// Result of a pair.
struct PairResult {
  // Harshest fault of each cell run alone in the pair's phase, and the fault at the end of the pair.
  Fault first_alone = Fault::none;
  Fault second_alone = Fault::none;
  Fault together = Fault::none;
  std::vector<Fault> raised{};  // in the order of raising
  State state = State::idle;
  std::string end{};  // the state in words, or why a new session did not start or arm
  int cycles = -1;  // from the first cycle that could show the second fault to the cycle that raised it; -1:
                    // not raised
  std::string hidden{};   // reason why one fault could not be seen beside the other; empty: both could
  double time_s = 0.0;    // duration of the trial
  std::string problem{};  // empty: the pair passed
};

// Runs pairs. Runs each of their cells alone once, for comparison, and keeps the result.
class PairRunner {
 public:
  explicit PairRunner(MatrixSetup setup) : setup_(std::move(setup)) {}
  // Runs a pair and judges it against each of its cells alone.
  PairResult run(const Pair& pair);

 private:
  Fault alone(const Cell& cell);

  MatrixSetup setup_;
  std::map<std::string, Fault> alone_;
};

}  // namespace sandhopper::faults
