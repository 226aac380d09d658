#include "tools/diagnose/fit/spread_seen.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kFarLess = 0.3;  // largest spread, as a share of the believed one or of the shared shift
// New standard deviation: kHeldUp times the spread seen, at least kLeastSpread times the believed one.
constexpr double kHeldUp = 2.0, kLeastSpread = 0.05;
// Standard deviation over median absolute deviation, for a normal distribution.
constexpr double kMadOfNormal = 1.4826;

}  // namespace

std::vector<Point> take_spread_as_seen(Problem& problem, Point& point) {
  if (problem.trials.size() < kTooFewTrials) return {};
  std::vector<std::pair<std::string, double>> found;  // label of the effect, shared value
  for (std::size_t i = 0; i < problem.trials.front()->trial_nuisances.size(); ++i) {
    const Nuisance first = problem.trials.front()->trial_nuisances[i];
    const bool everywhere = std::ranges::all_of(problem.trials, [&](const auto& trial) {
      return trial->trial_nuisances.size() > i && trial->trial_nuisances[i].name == first.name;
    });
    if (first.shared_as.empty() || !everywhere) continue;
    // Medians, because the fit of a single trial may not have converged.
    std::vector<double> values, apart;
    for (const auto& own : point.nuisances) values.push_back(own[i]);
    const double shared = median(values);
    for (const double value : values) apart.push_back(std::abs(value - shared));
    const double seen = kMadOfNormal * median(apart);
    if (seen > kFarLess * std::max(first.sd, std::abs(shared))) continue;
    for (auto& trial : problem.trials) {
      trial->trial_nuisances[i].sd = std::max(kHeldUp * seen, kLeastSpread * first.sd);
      trial->trial_nuisances[i].shift_is_evidence = false;  // the believed spread no longer applies
    }
    for (auto& own : point.nuisances) own[i] = 0.0;
    found.emplace_back(first.shared_as, shared);
  }
  std::vector<Point> starts;
  for (const auto& [label, shared] : found)
    for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
      if (problem.candidates[c].label() != label) continue;
      starts.push_back(point);
      starts.back().hypothesis = {.candidates = {c}, .values = {{shared}}};
    }
  return starts;
}

}  // namespace sandhopper::diagnose
