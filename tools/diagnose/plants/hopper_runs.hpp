#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/diagnose/plants/hopper_simulation.hpp"

namespace sandhopper::diagnose {

// Runs of a hopper that were made already: what only a sensor reads otherwise needs no new one. Of one trial,
// and so of one thread at a time.
class HopperRuns {
 public:
  // Of everything that changes the run itself; empty: not known.
  using Key = std::vector<double>;
  // `plant_nuisances`: those that change the run, not only what a sensor reads of it.
  static Key key(const Edits& edits, std::span<const double> plant_nuisances);

  template <class Make>
  const HopperTraces& traces(const Key& key, std::uint32_t block, Make&& make) {
    if (const auto* known = find(key, block)) return *known;
    return keep(key, block, make());
  }

 private:
  struct Run {
    Key key{};
    std::uint32_t block = 0;
    std::uint64_t used = 0;
    HopperTraces traces{};
  };
  const HopperTraces* find(const Key& key, std::uint32_t block);
  const HopperTraces& keep(const Key& key, std::uint32_t block, HopperTraces traces);

  std::array<Run, 6> runs_{};
  std::uint64_t clock_ = 0;
};

}  // namespace sandhopper::diagnose
