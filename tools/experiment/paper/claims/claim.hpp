#pragma once
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace sandhopper::paper {

enum class Verdict { comes_out, only_if, does_not };
std::string_view words(Verdict verdict);  // "comes out", "comes out only if", "does not come out"

struct ClaimFigure {
  std::string name;
  double value;
  std::string unit;  // empty: a pure number
  int digits = 3;    // after the point, for people
  // Of a mean over trials: the smallest and the largest.
  double lowest = std::numeric_limits<double>::quiet_NaN();
  double highest = std::numeric_limits<double>::quiet_NaN();
};

// One statement of the paper, what would make it true here, what was found, and what follows.
struct Claim {
  int number = 0;
  std::string statement;
  std::string pass_line;
  std::vector<ClaimFigure> figures{};
  Verdict verdict = Verdict::does_not;
  std::string why{};  // the condition, or the reason
};

inline Verdict comes_out_if(bool passed) { return passed ? Verdict::comes_out : Verdict::does_not; }

// For a statement about every trial: 95 % of them make it true, 5 % or less make it false, between the two it
// depends.
Verdict verdict_of_share(double share);

}  // namespace sandhopper::paper
