#pragma once
#include <nlohmann/json.hpp>

#include "tools/benchmark/records.hpp"

namespace sandhopper::benchmark {

// The cells (channel and phase) that diagnoses report, compared with those in which a hidden effect exceeds
// the noise: of one campaign, or the sum of several.
struct Localisation {
  std::size_t campaigns = 0;
  std::size_t true_positives = 0;   // reported, and a hidden effect is there
  std::size_t false_positives = 0;  // reported, and no hidden effect is there
  std::size_t missed = 0;           // not reported, although a hidden effect is there

  std::optional<double> precision() const;  // true positives / reported; nullopt if none are reported
  std::optional<double> recall() const;     // true positives / cells with a hidden effect
  std::optional<double> f1() const;         // harmonic mean of both, 2 TP / (2 TP + FP + missed)
  bool met() const { return f1().value_or(0.0) >= kMust; }
  Localisation& operator+=(const Localisation& other);

  // Limits of F1: the one that is checked, and that of a good result.
  static constexpr double kMust = 0.75, kAim = 0.85;
};

// nullopt if the campaign is not scored: the diagnosis does not say that physics is missing, or the answer
// states no cells.
std::optional<Localisation> localise(const Truth& truth, const Diagnosis& diagnosis);

nlohmann::ordered_json to_json(const Localisation& localisation);

}  // namespace sandhopper::benchmark
