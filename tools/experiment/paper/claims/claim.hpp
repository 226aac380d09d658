#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace sandhopper::paper {

enum class Verdict { comes_out, only_if, does_not };
std::string_view words(Verdict verdict);  // "holds", "holds on a condition", "does not hold"

struct ClaimFigure {
  std::string name;
  double value;
  std::string unit;  // empty: a pure number
  int digits = 3;    // digits after the decimal point, for people
  // Smallest and largest value, if `value` is a mean over trials.
  double lowest = std::numeric_limits<double>::quiet_NaN();
  double highest = std::numeric_limits<double>::quiet_NaN();
};

// One statement of the paper, the criterion for it to hold here, the values found, and the verdict.
struct Claim {
  int number = 0;
  std::string
      statement;  // this and the other texts may hold equations between ⟦ and ⟧ (tools/report/study_text.hpp)
  std::string pass_line;
  std::vector<ClaimFigure> figures{};
  Verdict verdict = Verdict::does_not;
  std::string why{};  // the condition, or the reason
};

inline Verdict comes_out_if(bool passed) { return passed ? Verdict::comes_out : Verdict::does_not; }

// "27 of 36 claims hold, 8 only on a condition, 1 does not."
std::string summary(const std::vector<Claim>& claims);

// Verdict for a statement about every trial. It holds if it is true in at least 95 % of them and fails if it
// is true in 5 % or less. In between it holds only under a condition.
Verdict verdict_of_share(double share);

}  // namespace sandhopper::paper
