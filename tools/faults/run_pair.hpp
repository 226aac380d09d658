#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/faults/pair.hpp"
#include "tools/faults/run_cell.hpp"

namespace sandhopper::faults {

// Result of a pair.
struct PairResult {
  // The harshest fault of each alone, in the pair's phase, and of the pair at its end.
  Fault first_alone = Fault::none;
  Fault second_alone = Fault::none;
  Fault together = Fault::none;
  std::vector<Fault> raised{};  // in their order
  State state = State::idle;
  std::string end{};      // the state in words, with the reason when a new session did not arm
  int cycles = -1;        // until the second was raised, when it had to be
  std::string hidden{};   // why the second could not be seen beside the first, when that is so
  double time_s = 0.0;    // of the trial
  std::string problem{};  // empty: as it must be
};

// Runs pairs, and once each of their cells alone for comparison.
class PairRunner {
 public:
  explicit PairRunner(MatrixSetup setup) : setup_(std::move(setup)) {}
  PairResult run(const Pair& pair);

 private:
  Fault alone(const Cell& cell);

  MatrixSetup setup_;
  std::map<std::string, Fault> alone_;
};

}  // namespace sandhopper::faults
