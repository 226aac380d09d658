#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/diagnose/report_parts.hpp"
#include "tools/diagnose/search_parts.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// "mass_change_kg" of "mass_kg".
std::string change_of(const std::string& name) {
  for (const char* unit :
       {"_N_s2_per_m2", "_N_s_per_m", "_N_per_m3", "_N_per_m", "_Nm_per_A", "_Nm_s2", "_Nm_s", "_kg_m2",
        "_radps", "_mps2", "_mps", "_rad", "_Nm", "_kg", "_N", "_m", "_s"})
    if (name.ends_with(unit))
      return name.substr(0, name.size() - std::string(unit).size()) + "_change" + unit;
  return name + "_change";
}

std::string filled(std::string text, const std::string& channel) {
  if (const auto at = text.find("{channel}"); at != std::string::npos) text.replace(at, 9, channel);
  return text;
}

}  // namespace

void report_effects(const Problem& problem, const Search& search, const Posterior& belief,
                    Diagnosis& diagnosis) {
  const SetFit& best = search.best();
  const Point& point = best.fit.point;
  const double explained = std::max(1e-300, search.null().fit.deviance - best.fit.deviance);
  const MatrixXd& covariance = best.evidence.covariance;
  const double quantile = student_t_quantile(0.05, 4.0 + static_cast<double>(problem.trials.size()) - 1.0);
  Index at = 0;
  for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
    const auto c = point.hypothesis.candidates[e];
    const Candidate& candidate = problem.candidates[c];
    FoundEffect found;
    found.id = candidate.effect->id;
    found.port = port_of(candidate);
    found.channel = candidate.channel;
    found.statement = filled(candidate.effect->statement, candidate.channel);
    found.equation = candidate.effect->equation;
    for (std::size_t j = 0; j < candidate.parameters.size(); ++j, ++at) {
      const auto& p = candidate.parameters[j];
      const double value = point.hypothesis.values[e][j];
      const double half = quantile * std::sqrt(std::max(0.0, covariance(at, at))) * p.typical;
      FoundParameter out{p.name, p.reported(value), p.reported(std::max(p.low, value - half)),
                         p.reported(std::min(p.high, value + half)), false};
      if (p.scale == 0.0) {  // a limit is read off, at best within a thousandth
        const double within = p.resolution + 1e-3 * std::abs(out.value);
        out.low = out.value - within;
        out.high = out.value + within;
      }
      if (out.low > out.high) std::swap(out.low, out.high);
      found.parameters.push_back(out);
      // What was added to the belief, where that held something already.
      if (p.base != 0.0 && p.scale != 0.0 && p.power == 1.0)
        found.parameters.push_back(
            {change_of(p.name), out.value - p.base, out.low - p.base, out.high - p.base, true});
    }
    found.probability = belief.probability.contains(c) ? belief.probability.at(c) : 0.0;
    found.indistinguishable_from = candidate.effect->same_as;
    if (const auto it = belief.alternatives.find(c); it != belief.alternatives.end())
      for (const auto other : it->second) {
        const auto& id = problem.candidates[other].effect->id;
        auto& list = found.indistinguishable_from;
        if (id != found.id && std::find(list.begin(), list.end(), id) == list.end()) list.push_back(id);
      }
    found.heldout_gain = std::min(1.0, best.evidence.trials[e].held_out_drop() / explained);
    found.p_value = std::max(best.evidence.trials[e].p_value(), 1e-300);
    found.typicals = typicals_of(problem, point.hypothesis, e);
    diagnosis.effects.push_back(std::move(found));
  }
  std::ranges::sort(diagnosis.effects, std::greater<>{}, &FoundEffect::heldout_gain);
}

}  // namespace sandhopper::diagnose
