#pragma once
#include <functional>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

struct EngineOptions {
  // Largest number of effects in one set. For a plant that simulates fast, the search goes on to six while
  // the set leaves more than the noise (rounds.cpp).
  std::size_t most_effects = 3;
  bool tell_evidence = false;  // Append the posterior mass of the best sets to the log.
  // Believed numbers with their sources. Copied to the answer, which adds the error of each that would show.
  std::vector<BelievedNumber> belief{};
  // Called with the fraction of work done and the step that begins.
  std::function<void(double share, const char* step)> progress = [](double, const char*) {};
  // Called once with the preliminary verdict.
  std::function<void(const std::string& verdict)> first_verdict = [](const std::string&) {};
  // Asked before each whole step (the fit of a set of effects). Once true, the answer is what is known so
  // far, and Diagnosis::stopped_in names the step.
  std::function<bool()> stop = [] { return false; };
};

// Finds the differences between the recordings and the belief. Deterministic.
Diagnosis diagnose(const Recordings& recordings, const EngineOptions& options = {});

}  // namespace sandhopper::diagnose
