#include "tools/conceal/cells.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

#include "tools/conceal/core/difference.hpp"

namespace sandhopper::conceal {
namespace {

using Place = std::pair<std::string, std::string>;  // channel and phase
using Differences = std::map<Place, MeanSquare>;

// Differences by channel and phase; `phases` are those of the rows of `a`.
Differences between(const Table& a, const Table& b, const std::vector<std::string>& phases) {
  Differences found;
  for_each_difference(a, b, [&](const std::string& channel, std::size_t row, double d) {
    found[{channel, phases[row]}].add(d);
  });
  return found;
}

// Differences in each trial: between two recordings with nothing hidden that differ in their sensor noise,
// and between the recordings with and without each hidden effect.
struct Compared {
  std::vector<Differences> repeats;
  std::vector<std::vector<Differences>> effects;  // by effect, then by trial
};

// The recordings are compared without their gaps, which remove a few milliseconds of some trials.
Compared compare(const Case& c) {
  const auto plain = build(c, {});
  std::vector<std::unique_ptr<Bench>> without;
  for (std::size_t e = 0; e < c.hidden.size(); ++e) {
    auto others = c.hidden;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(e));
    without.push_back(build(c, others));
  }
  Compared compared{{}, std::vector<std::vector<Differences>>(c.hidden.size())};
  for (std::size_t i = 0; i < c.setups.size(); ++i) {
    const auto& setup = c.setups[i];
    const auto trial = c.recording.stream("trial", i);
    const auto quiet = plain->record(setup, trial);
    const auto again = plain->record(setup, TrialRandom(trial, c.recording.stream("noise of a repeat", i)));
    compared.repeats.push_back(between(quiet, again, plain->phases(setup, trial, quiet)));
    const auto all = c.bench->record(setup, trial);
    const auto phases = c.bench->phases(setup, trial, all);
    for (std::size_t e = 0; e < c.hidden.size(); ++e)
      compared.effects[e].push_back(between(all, without[e]->record(setup, trial), phases));
  }
  return compared;
}

Differences pooled(const std::vector<Differences>& trials) {
  Differences sum;
  for (const auto& trial : trials)
    for (const auto& [place, differences] : trial) sum[place].add(differences);
  return sum;
}

bool is_data_fault(const HiddenEffect& effect) {
  return effect.info.id == "data.dropout" || effect.info.id == "data.stuck";
}

}  // namespace

std::vector<EffectCells> cells_of_effects(const Case& c) {
  if (c.hidden.empty()) return {};
  const auto compared = compare(c);
  const auto repeats = pooled(compared.repeats);
  const auto inputs = c.plant->inputs();
  std::vector<EffectCells> all;
  for (std::size_t e = 0; e < c.hidden.size(); ++e) {
    const auto& trials = compared.effects[e];
    std::vector<Cell> cells;
    bool in_an_input = false;
    for (const auto& [place, differences] : pooled(trials)) {
      const auto& [channel, phase] = place;
      const auto repeat = repeats.find(place);
      if (channel == c.dead_channel || repeat == repeats.end() || repeat->second.rms() <= 0.0) continue;
      const double noise = repeat->second.rms() / std::numbers::sqrt2;
      Cell cell{channel, phase, differences.rms() / noise, 0.0};
      for (const auto& trial : trials)
        if (const auto found = trial.find(place); found != trial.end())
          cell.max_trial_ratio = std::max(cell.max_trial_ratio, found->second.rms() / noise);
      if (cell.max_trial_ratio <= 1.0) continue;
      if (std::find(inputs.begin(), inputs.end(), channel) != inputs.end())
        in_an_input = true;
      else
        cells.push_back(cell);
    }
    const bool not_localised = is_data_fault(c.hidden[e]) || (cells.empty() && in_an_input);
    all.push_back(not_localised ? std::nullopt : EffectCells(std::move(cells)));
  }
  return all;
}

}  // namespace sandhopper::conceal
