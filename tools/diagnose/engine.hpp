#pragma once
#include <functional>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {
// `most_effects`: largest number of effects in one set.

struct EngineOptions {
  std::size_t most_effects = 3;
  bool tell_evidence = false;  // Append the posterior mass of the best sets to the log.
  // Copied to the answer, which adds its results for each of these numbers.
  std::vector<BelievedNumber> belief{};
  // Called with the fraction of work done. The first text that is not empty is the preliminary verdict.
  std::function<void(double share, const std::string& text)> progress = [](double, const std::string&) {};
};

// Finds the differences between the recordings and the belief. Deterministic.
Diagnosis diagnose(const Recordings& recordings, const EngineOptions& options = {});

}  // namespace sandhopper::diagnose
