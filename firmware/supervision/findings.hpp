#pragma once
#include <array>
#include <bitset>

#include "firmware/fault.hpp"

namespace sandhopper {

// The fault with the harsher reaction takes precedence. If the reactions are equal, the one with the stricter
// latch does. If both are equal, the first fault found stays.
constexpr bool is_harsher(Fault fault, Fault than) noexcept {
  const FaultEntry &a = entry_of(fault), &b = entry_of(than);
  return a.reaction != b.reaction ? a.reaction > b.reaction : a.latch > b.latch;
}

// A stricter latch requires the harshest reaction, so a harsher fault never loosens a latch.
constexpr bool strict_latches_are_limp() {
  for (const auto& entry : kFaults)
    if (entry.latch > Latch::until_disarmed && entry.reaction != Reaction::limp) return false;
  return true;
}
static_assert(strict_latches_are_limp());

struct FaultFound {
  Fault fault = Fault::none;
  std::array<double, 2> values{};  // measured and allowed value
};

// Detectors that are switched off, by the number of their fault. Only tests of the tests use it, never the
// daemon.
using DetectorMask = std::bitset<kFaultCount>;

// Result of one cycle's checks: the harshest fault.
class Findings {
 public:
  explicit Findings(const DetectorMask& off) noexcept : off_(off) {}

  void add(Fault fault, double seen, double allowed) noexcept {
    if (off_[static_cast<std::size_t>(fault)]) return;
    if (worst_.fault != Fault::none && !is_harsher(fault, worst_.fault)) return;
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
