#pragma once
#include "tools/benchmark/localisation.hpp"
#include "tools/benchmark/records.hpp"

namespace sandhopper::benchmark {

// One campaign's diagnosis, compared with its answer.
struct Judged {
  const Truth* truth = nullptr;
  bool answered = false;
  bool alarm = false;  // The verdict is missing or unknown physics.
  bool insufficient = false;
  bool right = false;  // The most probable name, or its class, is hidden.
  // The set of names is the set of hidden effects; a class counts if it contains the effect.
  bool exact = false;
  std::size_t class_size = 0;    // class size of the right claim
  bool confident_wrong = false;  // A wrong name with probability >= 0.8.
  bool unknown_flagged = false;  // "unknown@" any port
  bool unknown_at_port = false;  // "unknown@" the right port
  // Ratio of the held-out error to the noise floor.
  std::optional<double> heldout_over_floor;
  std::string said;  // Short text for the table of cases.

  struct Graded {
    double probability;
    bool right;
  };
  std::vector<Graded> graded;  // Every claimed name, for the calibration.
  std::size_t intervals = 0, intervals_hold = 0, intervals_without_counterpart = 0;
  // Hidden effects called absent, and those of them that are within the stated bound.
  std::size_t bounded = 0, bounds_hold = 0;
  std::optional<Localisation> localisation;  // nullopt: not scored
};

// Probability from which a claim counts as confident.
constexpr double kConfident = 0.8;

// True if the answer is right for its kind of campaign: nothing missing, unknown at the right port, the exact
// set, or the name or class of the single effect.
bool passed(const Judged& judged);

// Compares one diagnosis with the truth. nullopt: the tool gave no answer.
Judged judge(const Truth& truth, const std::optional<Diagnosis>& diagnosis);

// The parameter of the claim that is the same quantity as the hidden `key`: the same name, else the only one
// with its unit on both sides. The unit is the end of the name (config/hint.hpp). Null if there is none or it
// has no interval.
const Claim::Value* counterpart(const Truth::Effect& effect, const std::string& key, const Claim& claim);

}  // namespace sandhopper::benchmark
