#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"

namespace sandhopper::diagnose {

// Runs of a hopper that were made already, and what was read of them: what only a sensor reads otherwise
// needs no new run, and other sensors none of their readings. Of one trial, and so of one thread at a time.
class HopperRuns {
 public:
  // Of everything that changes the run itself, or what a sensor reads of it; empty: not known.
  using Key = std::vector<double>;
  // `plant_nuisances`: those that change the run, not only what a sensor reads of it.
  static Key key(const Edits& edits, std::span<const double> plant_nuisances);
  // `own_nuisances`: those that change what this sensor reads of one run.
  static Key reading_key(const Edits& edits, std::string_view channel, std::span<const double> own_nuisances);

  class Run {
   public:
    HopperTraces traces{};

    // Fills `out` with what `make` would.
    template <class Make>
    void read(std::size_t channel, const Key& key, std::span<double> out, Make&& make) {
      if (channel >= readings_.size()) readings_.resize(channel + 1);
      if (readings_[channel].copied(key, out)) return;
      make(out);
      readings_[channel] = {key, {out.begin(), out.end()}};
    }

   private:
    friend class HopperRuns;
    struct Reading {
      Key key{};
      std::vector<double> values{};
      bool copied(const Key& wanted, std::span<double> out) const;
    };
    Key key_{};
    std::uint32_t block_ = 0;
    std::uint64_t worth_ = 0;
    std::vector<Reading> readings_{};
  };

  explicit HopperRuns(std::size_t kept = 6) : runs_(kept) {}

  template <class Make>
  Run& run(const Key& key, std::uint32_t block, Make&& make) {
    if (auto* known = find(key, block)) return *known;
    return keep(key, block, make());
  }

 private:
  Run* find(const Key& key, std::uint32_t block);
  Run& keep(const Key& key, std::uint32_t block, HopperTraces traces);

  std::vector<Run> runs_;
  std::uint64_t clock_ = 0;
};

}  // namespace sandhopper::diagnose
