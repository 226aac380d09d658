#pragma once
#include <string>
#include <vector>

#include "tools/faults/cell.hpp"

namespace sandhopper::faults {

// Two faults in one trial. Both cells belong to the phase in which the first fault is planted.
struct Pair {
  Cell first;
  Cell second;
  int delay_cycles;  // from the cycle that raises the first fault (from its injection if it raises none) to
                     // the injection of the second; kTogether: both between the same two cycles

  // For example "imu_body off in flight, 20 cycles later tof off".
  std::string name() const;
};
inline constexpr int kTogether = -1;

// Every ordered pair of defects, each in one phase and with one delay. Phase and delay change from pair to
// pair.
std::vector<Pair> all_pairs();

// `count` pairs drawn without replacement; the same seed gives the same pairs.
std::vector<Pair> some_pairs(std::size_t count, std::uint64_t seed);

// Group of the cell's device, a column of PairTable.
std::string class_of(const Cell& cell);

}  // namespace sandhopper::faults
