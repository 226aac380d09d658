#pragma once
#include "tools/benchmark/records.hpp"

namespace sandhopper::benchmark {

// One campaign's diagnosis held against its answer.
struct Judged {
  const Truth* truth = nullptr;
  bool answered = false;
  bool alarm = false;  // says that physics is missing or unknown
  bool insufficient = false;
  bool right = false;            // one effect hidden: its name or class comes first
  bool exact = false;            // the set of names is the set of what is hidden, classes counted
  std::size_t class_size = 0;    // of the claim that is right
  bool confident_wrong = false;  // a name of probability 0.8 or more that nothing hidden answers to
  bool unknown_flagged = false;  // "unknown@" any port
  bool unknown_at_port = false;  // "unknown@" the right one
  std::optional<double> heldout_over_floor;
  std::string said;  // in short, for the table of cases

  struct Graded {
    double probability;
    bool right;
  };
  std::vector<Graded> graded;  // every name claimed, for calibration
  std::size_t intervals = 0, intervals_hold = 0, intervals_without_counterpart = 0;
  // Hidden effects that the answer calls absent, and those of them that are no larger than its bound.
  std::size_t bounded = 0, bounds_hold = 0;
};

constexpr double kConfident = 0.8;

// Whether it says what its kind of campaign asks for: nothing, unknown at the right port, the exact set, or
// the one effect's name or class.
bool passed(const Judged& judged);

Judged judge(const Truth& truth, const std::optional<Diagnosis>& diagnosis);

// The parameter of the claim that is the same quantity as the truth's `key`: the same name, else the only one
// of its unit on either side. The unit is the name's ending (config/hint.hpp).
const Claim::Value* counterpart(const Truth::Effect& effect, const std::string& key, const Claim& claim);

}  // namespace sandhopper::benchmark
