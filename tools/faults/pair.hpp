#pragma once
#include <string>
#include <vector>

#include "tools/faults/cell.hpp"

namespace sandhopper::faults {

// Two faults in one trial. Both cells are of the same phase, the one in which the first comes.
struct Pair {
  Cell first;
  Cell second;
  int delay_cycles;  // from the cycle in which the first was raised (from its injection, where it raises
                     // nothing) to the injection of the second; kTogether: both between the same two cycles

  std::string name() const;
};
inline constexpr int kTogether = -1;

// Every ordered pair of what can be broken, each in one phase and after one delay, which change from pair to
// pair.
std::vector<Pair> all_pairs();

// So many of them, drawn without replacement; the same seed draws the same.
std::vector<Pair> some_pairs(std::size_t count, std::uint64_t seed);

// Groups for a table.
std::string class_of(const Cell& cell);

}  // namespace sandhopper::faults
