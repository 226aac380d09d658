#include "tools/experiment/paper/claims/claim.hpp"

namespace sandhopper::paper {

std::string_view words(Verdict verdict) {
  switch (verdict) {
    case Verdict::comes_out:
      return "comes out";
    case Verdict::only_if:
      return "comes out only if";
    case Verdict::does_not:
      break;
  }
  return "does not come out";
}

Verdict verdict_of_share(double share) {
  if (share >= 0.95) return Verdict::comes_out;
  return share > 0.05 ? Verdict::only_if : Verdict::does_not;
}

}  // namespace sandhopper::paper
