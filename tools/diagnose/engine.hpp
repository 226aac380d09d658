#pragma once
#include <functional>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

struct EngineOptions {
  std::size_t most_effects = 3;
  bool tell_evidence = false;            // of what the search puts first, in the log
  std::vector<BelievedNumber> belief{};  // what the answer says of them is added to it
  // Called with the share of work done; the first call with a text other than empty is the quick verdict.
  std::function<void(double share, const std::string& text)> progress = [](double, const std::string&) {};
};

// Finds what the recordings hold that the belief does not. Deterministic.
Diagnosis diagnose(const Recordings& recordings, const EngineOptions& options = {});

}  // namespace sandhopper::diagnose
