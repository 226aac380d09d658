#include "tools/diagnose/fit/problem.hpp"

#include <algorithm>
#include <bit>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/model/parameter_names.hpp"

namespace sandhopper::diagnose {
namespace {

std::uint64_t mixed(std::uint64_t key, std::uint64_t value) {
  key ^= value + 0x9e3779b97f4a7c15ull + (key << 6) + (key >> 2);
  return key * 0xff51afd7ed558ccdull;
}

}  // namespace

Point null_point(const Problem& problem) {
  Point point;
  point.tolerances.assign(problem.tolerances.size(), 0.0);
  for (const auto& trial : problem.trials) point.nuisances.emplace_back(trial->nuisance_count(), 0.0);
  return point;
}

std::vector<std::string> put_in_place(Problem& problem) {
  std::vector<std::string> unknown;
  // The belief may state the shape of a law that these trials alone do not show.
  Context stated = problem.context;
  stated.facts.range_of_pushes = stated.facts.most_pushes;
  stated.facts.range_of_wait_s = stated.facts.longest_wait_s;
  for (const auto& [label, given] : problem.context.belief.effects) {
    const std::string name = label.substr(0, label.find('#'));
    const auto candidate = std::find_if(problem.candidates.begin(), problem.candidates.end(),
                                        [&](const Candidate& c) { return c.label() == name; });
    if (candidate == problem.candidates.end()) {
      unknown.push_back(label);
      continue;
    }
    std::vector<double> values;
    for (const auto& parameter : candidate->effect->parameters(stated, candidate->channel)) {
      const double unstated = values.empty() ? 0.0 : parameter.typical;
      values.push_back(given_value(parameter, given).value_or(unstated));
    }
    candidate->effect->apply(stated, candidate->channel, values, problem.in_place);
  }
  for (auto& edit : problem.in_place.sensors) edit.law_key = 1;
  return unknown;
}

void Tolerance::put(Edits& edits, double in_scales) const {
  if (window_s > 0.0)
    edits.sensor(channel, SensorEdit::Kind::mean_share, in_scales * scale, window_s);
  else if (belief_key.empty())
    edits.sensor(channel, SensorEdit::Kind::delay_s, in_scales * scale);
  else if (is_relative)
    edits.scale(belief_key, 1.0 + in_scales * scale);
  else
    edits.add(belief_key, in_scales * scale);
}

Edits edits_for(const Problem& problem, const Hypothesis& hypothesis, std::span<const double> tolerances) {
  Edits edits = problem.in_place;
  edits.laws_key = 1;
  for (std::size_t i = 0; i < hypothesis.candidates.size(); ++i) {
    const Candidate& candidate = problem.candidates[hypothesis.candidates[i]];
    const std::size_t laws = edits.laws.size(), sensors = edits.sensors.size();
    candidate.effect->apply(problem.context, candidate.channel, hypothesis.values[i], edits);
    std::uint64_t key = mixed(1, hypothesis.candidates[i]);
    for (const double value : hypothesis.values[i]) key = mixed(key, std::bit_cast<std::uint64_t>(value));
    if (edits.laws.size() > laws) edits.laws_key = mixed(edits.laws_key, key);
    for (std::size_t k = sensors; k < edits.sensors.size(); ++k) edits.sensors[k].law_key = key;
  }
  for (std::size_t k = 0; k < hypothesis.law.size(); ++k)
    edits = with_term(std::move(edits), hypothesis.law[k], hypothesis.law_sizes[k]);
  for (std::size_t i = 0; i < tolerances.size(); ++i)
    if (tolerances[i] != 0.0) problem.tolerances[i].put(edits, tolerances[i]);
  return edits;
}

}  // namespace sandhopper::diagnose
