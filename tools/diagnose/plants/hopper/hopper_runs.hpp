#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"

namespace sandhopper::diagnose {

// Runs of a hopper that were made already, and what was read of them: what only a sensor reads otherwise
// needs no new run, and other sensors none of their readings. A run that differs from a known one only in the
// ground goes on from it at the touchdown, or from the depth at which the bed first differs; where the foot
// never gets there, it is that run. Of one trial, and so of one thread at a time.
class HopperRuns {
 public:
  // Of everything that changes what a sensor reads of a run; empty: not known.
  using ReadingKey = std::vector<double>;
  // Of everything that changes the run itself, by where it acts.
  struct Key {
    std::vector<double> always{};     // empty: not known
    std::vector<double> in_ground{};  // while the foot is in the ground; empty: not known
    std::vector<double> by_depth{};   // the bed's fluctuation: [i] acts below (i - 1) knot_spacing_m
    double knot_spacing_m = 0.0;

    bool known() const { return !always.empty() && !in_ground.empty(); }
    // The depth from which on the bed differs; 0 where anything else in the ground does.
    double differs_below_m(const Key& other) const;
    bool operator==(const Key& other) const;
  };
  // Nuisances of the run, not of what a sensor reads of it.
  struct RunNuisances {
    std::vector<double> always{}, in_ground{}, by_depth{};
    double knot_spacing_m = 0.0;
  };
  static Key key(const Edits& edits, RunNuisances nuisances);
  // `own_nuisances`: those that change what this sensor reads of one run.
  static ReadingKey reading_key(const Edits& edits, std::string_view channel,
                                std::span<const double> own_nuisances);

  class Run {
   public:
    HopperTraces traces{};

    // Fills `out` with what `make` would.
    template <class Make>
    void read(std::size_t channel, const ReadingKey& key, std::span<double> out, Make&& make) {
      if (channel >= readings_.size()) readings_.resize(channel + 1);
      if (readings_[channel].copied(key, out)) return;
      make(out);
      readings_[channel] = {key, {out.begin(), out.end()}};
    }

   private:
    friend class HopperRuns;
    struct Reading {
      ReadingKey key{};
      std::vector<double> values{};
      bool copied(const ReadingKey& wanted, std::span<double> out) const;
    };
    Key key_{};
    std::uint32_t block_ = 0;
    std::uint64_t worth_ = 0;
    std::vector<Reading> readings_{};
  };

  explicit HopperRuns(std::size_t kept = 6) : runs_(kept) {}

  // `make`, given where a known run may be resumed (or nowhere), returns the run.
  template <class Make>
  Run& run(const Key& key, std::uint32_t block, Make&& make) {
    if (auto* known = find(key, block)) return *known;
    return keep(key, block, make(resumed(key, block)));
  }

 private:
  Run* find(const Key& key, std::uint32_t block);
  HopperResumed resumed(const Key& key, std::uint32_t block);
  Run& keep(const Key& key, std::uint32_t block, HopperTraces traces);

  std::vector<Run> runs_;
  std::uint64_t clock_ = 0;
};

}  // namespace sandhopper::diagnose
