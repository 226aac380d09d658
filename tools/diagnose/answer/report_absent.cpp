#include <algorithm>
#include <cmath>
#include <map>

#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

using Set = std::vector<std::size_t>;

// Standard error in typical sizes above which the recordings do not bound the effect.
constexpr double kUnbounded = 1e6;

// All fitted subsets of the set, including itself and the empty set.
std::vector<Set> fitted_parts(const Search& search, const Set& set) {
  std::vector<Set> parts;
  for (const auto& [tried, fit] : search.sets())
    if (std::includes(set.begin(), set.end(), tried.begin(), tried.end())) parts.push_back(tried);
  return parts;
}

// 95 % bound of each effect's size, in typical sizes: the largest of all cases in which the effect stands
// beside the found ones or replaces some of them. A found name may be wrong; then the true effect may have
// its full size.
std::map<std::size_t, double> largest_sizes(const Problem& problem, Search& search, double quantile) {
  std::map<std::size_t, double> largest;
  const auto consider = [&](std::size_t candidate, double typicals) {
    auto& size = largest[candidate];
    size = std::max(size, typicals);
  };
  const auto parts = fitted_parts(search, search.best().set);
  for (const auto& part : parts)
    for (const auto& s : search.screened(part))
      consider(s.candidate, std::abs(s.evidence.size()) + quantile * s.evidence.standard_error());
  // If an effect is not linear, the fitted size may exceed the linear bound.
  for (const auto& [set, tried] : search.sets())
    for (std::size_t i = 0; i < tried.fit.point.hypothesis.candidates.size(); ++i) {
      const auto candidate = tried.fit.point.hypothesis.candidates[i];
      Set others = set;
      std::erase(others, candidate);
      if (std::ranges::find(parts, others) == parts.end()) continue;
      const auto& p = problem.candidates[candidate].parameters[0];
      consider(candidate, std::abs(tried.fit.point.hypothesis.values[i][0]) / p.typical);
    }
  return largest;
}

// True if the candidate may be present: it may replace a found effect, or an unknown effect may hide it (in
// the plant, or at the same sensor).
bool may_be_there(const Problem& problem, const Diagnosis& diagnosis, const Candidate& candidate) {
  return std::ranges::any_of(diagnosis.effects, [&](const FoundEffect& found) {
    if (found.is_unknown())
      return problem.context.has(found.port) ? candidate.channel == found.port : candidate.channel.empty();
    return std::ranges::any_of(found.indistinguishable_from,
                               [&](const auto& id) { return id == candidate.effect->id; });
  });
}

}  // namespace

void report_absent(const Problem& problem, Search& search, Diagnosis& diagnosis) {
  const double quantile = student_t_quantile(0.05, 4.0 + static_cast<double>(problem.trials.size()) - 1.0);
  for (const auto& [index, typicals] : largest_sizes(problem, search, quantile)) {
    const auto& candidate = problem.candidates[index];
    if (search.best().fit.point.hypothesis.contains(index) || !(typicals < kUnbounded) ||
        may_be_there(problem, diagnosis, candidate))
      continue;
    const auto& p = candidate.parameters[0];
    const double bound = typicals * p.typical * std::max(std::abs(p.scale), 1e-300);
    diagnosis.absent.push_back(
        {candidate.label(), p.name, p.power == 1.0 ? bound : std::pow(bound, p.power), typicals});
  }
  std::sort(diagnosis.absent.begin(), diagnosis.absent.end(),
            [](const Bound& a, const Bound& b) { return a.typicals > b.typicals; });
}

}  // namespace sandhopper::diagnose
