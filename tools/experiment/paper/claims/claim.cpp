#include "tools/experiment/paper/claims/claim.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sandhopper::paper {

std::string_view words(Verdict verdict) {
  switch (verdict) {
    case Verdict::comes_out:
      return "holds";
    case Verdict::only_if:
      return "holds on a condition";
    case Verdict::does_not:
      break;
  }
  return "does not hold";
}

std::string summary(const std::vector<Claim>& claims) {
  const auto count = [&](Verdict verdict) { return std::ranges::count(claims, verdict, &Claim::verdict); };
  const auto failed = count(Verdict::does_not);
  return fmt::format("{} of {} claims hold, {} only on a condition, {} {} not.", count(Verdict::comes_out),
                     claims.size(), count(Verdict::only_if), failed, failed == 1 ? "does" : "do");
}

Verdict verdict_of_share(double share) {
  if (share >= 0.95) return Verdict::comes_out;
  return share > 0.05 ? Verdict::only_if : Verdict::does_not;
}

}  // namespace sandhopper::paper
