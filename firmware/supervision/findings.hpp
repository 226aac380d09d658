#pragma once
#include <array>
#include <bitset>

#include "firmware/fault.hpp"

namespace sandhopper {

struct FaultFound {
  Fault fault = Fault::none;
  std::array<double, 2> values{};  // what was seen and what was allowed
};

// Detectors switched off, by the number of their fault. For tests of the tests only: nothing in the daemon
// sets one.
using DetectorMask = std::bitset<kFaultCount>;

// What the checks of one cycle found. The harshest reaction is kept; of equal ones the first.
class Findings {
 public:
  explicit Findings(const DetectorMask& off) noexcept : off_(off) {}

  void add(Fault fault, double seen, double allowed) noexcept {
    if (off_[static_cast<std::size_t>(fault)]) return;
    if (worst_.fault != Fault::none && entry_of(worst_.fault).reaction >= entry_of(fault).reaction) return;
    worst_ = {fault, {seen, allowed}};
  }
  void add_if(bool broken, Fault fault, double seen, double allowed) noexcept {
    if (broken) add(fault, seen, allowed);
  }
  const FaultFound& worst() const noexcept { return worst_; }

 private:
  const DetectorMask& off_;
  FaultFound worst_{};
};

}  // namespace sandhopper
