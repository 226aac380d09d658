#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "tools/diagnose/answer/masses.hpp"
#include "tools/diagnose/answer/parameter_errors.hpp"
#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/evidence/calibration.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;

// Loss of deviance on held-out trials without this effect, limited to the rise of the deviance in the fit
// without it. If two effects nearly cancel, each seems to explain much, but without it the other one shrinks,
// too.
double held_out_loss(const Search& search, const EffectEvidence& evidence) {
  const double drop = evidence.evidence.held_out_drop();
  auto rest = search.best().set;
  std::erase(rest, evidence.candidate);
  const auto it = search.sets().find(rest);
  if (it == search.sets().end()) return drop;
  return std::clamp(it->second.fit.deviance - search.best().fit.deviance, 0.0, drop);
}

std::string filled(std::string text, const std::string& channel) {
  if (const auto at = text.find("{channel}"); at != std::string::npos) text.replace(at, 9, channel);
  return text;
}

// Amplitude sqrt(a^2 + b^2) of a sine part `j` and the cosine part after it, with the interval of its
// linearisation at the fit. `at`: number of the sine part among all parameters.
FoundParameter amplitude_of(const Candidate& candidate, const std::vector<double>& values,
                            const ParameterErrors& errors, std::size_t j, Index at) {
  const auto &sine = candidate.parameters[j], &cosine = candidate.parameters[j + 1];
  const double amplitude = std::hypot(values[j], values[j + 1]);
  const Eigen::Vector2d along(sine.typical * values[j], cosine.typical * values[j + 1]);
  const double half = amplitude > 0.0 ? errors.half_width(at, along / amplitude) : 0.0;
  return {sine.amplitude_name, amplitude, std::max(0.0, amplitude - half), amplitude + half, true};
}

// Limit of a parameter's range at which its value lies, as reported, if more could lie beyond it. A size that
// cannot be negative has no value beyond 0.
std::optional<double> limit_of(const EffectParameter& p, double value) {
  if (p.is_whole_range || p.scale == 0.0 || (!p.at_low(value) && !p.at_high(value))) return {};
  const double limit = p.reported(p.at_high(value) ? p.high : p.low);
  return limit == 0.0 || !std::isfinite(limit) ? std::nullopt : std::optional(limit);
}

// Fitted parameters of one effect with their 95 % intervals. `at`: number of its first parameter among all.
std::vector<FoundParameter> parameters_of(const Candidate& candidate, const std::vector<double>& values,
                                          const ParameterErrors& errors, Index at) {
  std::vector<FoundParameter> found;
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j, ++at) {
    const auto& p = candidate.parameters[j];
    const double value = values[j];
    const double half = errors.half_width(at) * p.typical;
    FoundParameter out{p.name, p.reported(value), p.reported(std::max(p.low, value - half)),
                       p.reported(std::min(p.high, value + half)), false};
    out.limit = limit_of(p, value);
    if (p.scale == 0.0) {  // A limit is read from the data; assume an error of 1/1000.
      const double within = p.resolution + 1e-3 * std::abs(out.value);
      out.low = out.value - within;
      out.high = out.value + within;
    }
    if (out.low > out.high) std::swap(out.low, out.high);
    if (!p.other_name.empty()) {
      const auto other = [&](double reported) { return p.other_scale * (reported - p.base) / p.scale; };
      found.push_back({p.other_name, other(out.value), other(out.low), other(out.high), true});
    }
    if (!p.amplitude_name.empty()) found.push_back(amplitude_of(candidate, values, errors, j, at));
    found.push_back(out);
    // For a number that the belief already contains, also give its change.
    if (p.base != 0.0 && p.scale != 0.0 && p.power == 1.0)
      found.push_back(
          {change_of(p.name), out.value - p.base, out.low - p.base, out.high - p.base, true, true});
  }
  return found;
}

// Effects indistinguishable from a candidate: by their law, or on these recordings. Those of the same law
// that contradict [known_to] are left out if the candidate does not.
std::vector<std::string> class_of(const Problem& problem, std::size_t c, const Posterior& belief) {
  std::vector<std::string> list = problem.candidates[c].effect->same_as;
  if (!problem.candidates[c].contradicts_belief)
    for (const auto& other : problem.candidates)
      if (other.contradicts_belief) std::erase(list, other.effect->id);
  if (const auto it = belief.alternatives.find(c); it != belief.alternatives.end())
    for (const auto other : it->second) {
      const auto& id = problem.candidates[other].effect->id;
      if (id != problem.candidates[c].effect->id && std::find(list.begin(), list.end(), id) == list.end())
        list.push_back(id);
    }
  return list;
}

}  // namespace

double form_deviance(const Problem& problem, double explained) {
  constexpr double kAlong = 1.0 / 6.0;  // RMS share of a residual along a parameter
  return kAlong * kAlong * problem.plant->form_error() * std::max(0.0, explained);
}

void report_effects(const Problem& problem, const Search& search, const Posterior& belief,
                    Diagnosis& diagnosis) {
  const SetFit& best = search.best();
  const Point& point = best.fit.point;
  const double explained = std::max(1e-300, search.null().fit.deviance - best.fit.deviance);
  const ParameterErrors errors(problem, point, form_deviance(problem, explained));
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
    found.parameters = parameters_of(candidate, point.hypothesis.values[e], errors, at);
    at += static_cast<Index>(candidate.parameters.size());
    found.posterior_mass = found.mass = belief.mass.contains(c) ? belief.mass.at(c) : 0.0;
    found.indistinguishable_from = class_of(problem, c, belief);
    for (const auto& evidence : best.evidence)
      if (evidence.candidate == c) {
        found.heldout_gain = std::min(1.0, held_out_loss(search, evidence) / explained);
        found.p_value = std::max(evidence.p_value, 1e-300);
        found.typicals = evidence.typicals;
        found.mass = mass_alone(found.mass, evidence.weak);
      }
    diagnosis.effects.push_back(std::move(found));
  }
  limit_beside_each_other(diagnosis.effects);
}

}  // namespace sandhopper::diagnose
