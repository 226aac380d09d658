#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"

namespace sandhopper::diagnose {

// Cache of the runs of one trial and of the readings taken from them. An edit of a sensor alone needs no new
// run, and no new readings of the other sensors. Not thread-safe: each trial has its own.
class HopperRuns {
 public:
  // Holds everything that changes a run, or a reading of it. Empty: unknown, so nothing is cached.
  using Key = std::vector<double>;
  // `plant_nuisances`: those that change the run, not only its readings.
  static Key key(const Edits& edits, std::span<const double> plant_nuisances);
  // `own_nuisances`: those that change the readings of this sensor.
  static Key reading_key(const Edits& edits, std::string_view channel, std::span<const double> own_nuisances);

  class Run {
   public:
    HopperTraces traces{};

    // Writes the readings of a channel to `out`: the cached ones, or those that `make` computes.
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
