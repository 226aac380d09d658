#include "tools/benchmark/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace sandhopper::benchmark {
namespace {

bool is_unknown(const std::string& id) { return id.rfind("unknown@", 0) == 0; }

// The gradient of a hidden added mass is a quadratic drag, so that name is accepted beside it.
bool excused(const Claim& claim, const Truth& truth) {
  return claim.id == "terrain.quadratic_drag" && truth.holds("terrain.added_mass");
}

bool names_something_hidden(const Claim& claim, const Truth& truth) {
  return std::any_of(truth.effects.begin(), truth.effects.end(),
                     [&](const auto& e) { return claim.covers(e.id); });
}

// True if each hidden effect has its own claim and no claim is left over.
bool is_exact(const std::vector<Claim>& claims, const Truth& truth) {
  std::vector<const Truth::Effect*> open;
  for (const auto& effect : truth.effects) open.push_back(&effect);
  // Claims of a single name first, so that a class does not take the effect of another claim.
  auto ordered = claims;
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const Claim& a, const Claim& b) { return a.alike.size() < b.alike.size(); });
  for (const auto& claim : ordered) {
    const auto found =
        std::find_if(open.begin(), open.end(), [&](const auto* e) { return claim.covers(e->id); });
    if (found != open.end())
      open.erase(found);
    else if (!excused(claim, truth))
      return false;
  }
  return open.empty();
}

std::string unit_of(const std::string& key) {
  static constexpr std::array kUnits{"N_s2_per_m2", "N_s_per_m", "N_per_m", "Nm_per_rad", "Nm_s2", "Nm_s",
                                     "Nm",          "kg_m2",     "radps",   "mps2",       "mps",   "rad",
                                     "per_K",       "per_rev",   "kg",      "Hz",         "N",     "m",
                                     "s",           "V",         "C"};
  for (const char* unit : kUnits)
    if (key.size() > std::string(unit).size() + 1 && key.ends_with(std::string("_") + unit)) return unit;
  return "";
}

template <class Map>
std::size_t of_unit(const Map& map, const std::string& unit) {
  return static_cast<std::size_t>(
      std::count_if(map.begin(), map.end(), [&](const auto& entry) { return unit_of(entry.first) == unit; }));
}

void check_intervals(Judged& j, const Truth::Effect& effect, const Claim& claim) {
  for (const auto& [key, value] : effect.parameters) {
    const auto* claimed = counterpart(effect, key, claim);
    if (!claimed) {
      ++j.intervals_without_counterpart;
      continue;
    }
    ++j.intervals;
    j.intervals_hold += value >= claimed->low && value <= claimed->high;
  }
}

void check_bounds(Judged& j, const Truth::Effect& effect, const std::vector<UpperBound>& absent) {
  for (const auto& bound : absent) {
    const auto size = bound.size_of(effect);
    if (!size) continue;
    ++j.bounded;
    j.bounds_hold += bound.holds(*size);
  }
}

std::string in_short(const Diagnosis& d) {
  std::string text = d.verdict;
  for (const auto& claim : d.claims) {
    text += fmt::format(" {} {:.2f}", claim.id, claim.probability);
    for (const auto& other : claim.alike) text += " = " + other;
  }
  return text;
}

}  // namespace

const Claim::Value* counterpart(const Truth::Effect& effect, const std::string& key, const Claim& claim) {
  const auto same = claim.parameters.find(key);
  if (same != claim.parameters.end()) return same->second.has_interval ? &same->second : nullptr;
  const auto unit = unit_of(key);
  if (of_unit(effect.parameters, unit) != 1 || of_unit(claim.parameters, unit) != 1) return nullptr;
  for (const auto& [name, value] : claim.parameters)
    if (unit_of(name) == unit) return value.has_interval ? &value : nullptr;
  return nullptr;
}

bool passed(const Judged& j) {
  if (j.truth->nothing_hidden()) return j.answered && !j.alarm;
  if (j.truth->unknown_port) return j.unknown_at_port;
  return j.truth->effects.size() > 1 ? j.exact : j.right;
}

Judged judge(const Truth& truth, const std::optional<Diagnosis>& diagnosis) {
  Judged j;
  j.truth = &truth;
  j.said = "no answer";
  if (!diagnosis) return j;
  const auto& d = *diagnosis;
  j.answered = true;
  j.said = in_short(d);
  j.alarm = d.says_missing();
  j.insufficient = d.verdict == "insufficient_data";

  std::vector<Claim> names;
  for (const auto& claim : d.claims) {
    if (is_unknown(claim.id)) {
      j.unknown_flagged = true;
      j.unknown_at_port |= truth.unknown_port && claim.id == "unknown@" + *truth.unknown_port;
    } else if (j.alarm) {
      names.push_back(claim);
    }
  }
  for (const auto& claim : names) {
    const bool right = names_something_hidden(claim, truth) || excused(claim, truth);
    j.graded.push_back({claim.probability, right});
    j.confident_wrong |= !right && claim.probability >= kConfident;
  }
  j.exact = j.alarm && !truth.nothing_hidden() && !j.unknown_flagged && is_exact(names, truth);
  if (!names.empty() && names_something_hidden(names.front(), truth)) {
    j.right = true;
    j.class_size = 1 + names.front().alike.size();
  }
  for (const auto& effect : truth.effects)
    for (const auto& claim : names)
      if (claim.id == effect.id) check_intervals(j, effect, claim);
  for (const auto& effect : truth.effects) check_bounds(j, effect, d.absent);
  j.localisation = localise(truth, d);
  if (passed(j) && !truth.nothing_hidden() && d.heldout_after && d.floor && *d.floor > 0.0)
    j.heldout_over_floor = *d.heldout_after / *d.floor;
  return j;
}

}  // namespace sandhopper::benchmark
