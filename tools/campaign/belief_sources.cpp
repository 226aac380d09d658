#include "tools/campaign/belief_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <type_traits>

#include "config/hint.hpp"
#include "config/load.hpp"
#include "tools/campaign/belief_notes.hpp"
#include "tools/campaign/key_reference.hpp"
#include "tools/campaign/written_digits.hpp"

namespace sandhopper {
namespace {

using Numbers = std::vector<std::pair<std::string, double>>;

template <class T>
void flatten(const T& table, const std::string& prefix, Numbers& out) {
  T::fields(table, [&]<class Member>(std::string_view key, const Member& member, Range = {}) {
    const std::string name = prefix + std::string(key);
    if constexpr (HasFields<const Member>) {
      flatten(member, name + ".", out);
    } else if constexpr (std::is_arithmetic_v<Member>) {
      out.emplace_back(name, static_cast<double>(member));
    } else if constexpr (std::is_same_v<Member, std::optional<double>>) {
      if (member) out.emplace_back(name, *member);
    }
  });
}

// In the order of the fields.
Numbers numbers_in_order(const Belief& belief) {
  Numbers numbers;
  std::visit(
      [&](const auto& plant) {
        flatten(plant, "", numbers);
        for (const auto& spread : plant.key_spreads) numbers.emplace_back("spread." + spread.name, spread.sd);
        for (const auto& known : plant.known_to) numbers.emplace_back("known_to." + known.name, known.sd);
      },
      belief);
  return numbers;
}

// A set-up names no table. It states the first number of its name outside [spread] (override_belief).
bool is_first_of_its_name(const Numbers& numbers, const std::string& path) {
  if (states_uncertainty(path)) return false;
  const auto name = "." + path.substr(path.rfind('.') + 1);
  const auto first =
      std::ranges::find_if(numbers, [&](const auto& n) { return ("." + n.first).ends_with(name); });
  return first != numbers.end() && first->first == path;
}

// Line numbers in the model file. Key: "table.key".
std::map<std::string, std::uint64_t> lines_of(const std::filesystem::path& model) {
  std::map<std::string, std::uint64_t> lines;
  if (model.empty()) return lines;
  const auto document = parse_config_file(model.string());
  for (const auto& child : document.root.children) {
    if (child.kind != ConfigNode::Kind::table)
      lines[child.key] = static_cast<std::uint64_t>(child.key_position.line);
    if (child.kind == ConfigNode::Kind::table)
      for (const auto& inner : child.children)
        lines[child.key + "." + inner.key] = static_cast<std::uint64_t>(inner.key_position.line);
  }
  return lines;
}

std::string table_of(const std::string& key) {
  const auto dot = key.find('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

// Every plant accepts the sensors of all plants; a key that it does not use is no number of the answer.
std::set<std::string> unused_keys(CampaignPlant plant) {
  std::set<std::string> unused;
  for (const auto& key : belief_keys(plant))
    if (!key.used) unused.insert(key.path());
  return unused;
}

bool is_of_sensors(const std::string& key) {
  return key.starts_with("sensors.") || key.starts_with("spread.");
}

// By default the sensors of the simple plants have no limits and no disturbances, so the defaults of
// [sensors] and [spread] have no effect.
bool is_without_effect(CampaignPlant plant, const std::string& key) {
  const bool simple = plant == CampaignPlant::falling_body || plant == CampaignPlant::rotary_axis;
  const auto table = table_of(key);
  return simple && (table == "sensors" || table == "spread");
}

}  // namespace

std::map<std::string, double> numbers_of(const Belief& belief) {
  const auto numbers = numbers_in_order(belief);
  return {numbers.begin(), numbers.end()};
}

UsedNumbers used_numbers(const Campaign& campaign) {
  UsedNumbers used;
  const auto lines = lines_of(campaign.model);
  const auto errors = written_errors(campaign.model);
  std::vector<std::map<std::string, double>> of_trials;
  for (const auto& trial : campaign.trials) of_trials.push_back(numbers_of(trial.belief));
  const auto in_order = numbers_in_order(campaign.belief);
  const auto unused = unused_keys(campaign.plant);
  for (const auto& [key, value] : numbers_of(campaign.belief)) {
    const bool may_be_set_up = is_first_of_its_name(in_order, key);
    UsedNumber number{.key = key, .value = value, .low = value, .high = value, .unit = unit_of_key(key)};
    // Left at "?", a number is that of the trials which state it; a default is nobody's.
    const bool is_unstated =
        std::ranges::find(campaign.unstated, key, &UnstatedNumber::key) != campaign.unstated.end();
    std::size_t own = 0, seen = 0;
    for (std::size_t i = 0; i < of_trials.size(); ++i) {
      const auto it = of_trials[i].find(key);
      if (it == of_trials[i].end() || campaign.trials[i].is_unstated(key)) continue;
      own += is_unstated || it->second != value || (may_be_set_up && campaign.trials[i].states(key));
      number.low = seen == 0 ? it->second : std::min(number.low, it->second);
      number.high = seen == 0 ? it->second : std::max(number.high, it->second);
      if (may_be_set_up)
        number.written_error = std::max(number.written_error, written_error(campaign.trials[i], key));
      ++seen;
    }
    if (is_unstated && own == 0) continue;
    const auto line = lines.find(key);
    if (own > 0) {
      number.source = UsedNumber::Source::trial_setup;
      number.source_text = fmt::format("set-up of {} of {} trials", own, of_trials.size());
    } else if (line != lines.end()) {
      number.source = UsedNumber::Source::model_file;
      const auto error = errors.find(key);
      number.written_error = error == errors.end() ? 0.0 : error->second;
      number.source_text = fmt::format("{}, line {}", campaign.model.filename().string(), line->second);
    } else {
      if (unused.contains(key)) continue;
      if (value == 0.0) ++used.off;
      if (value == 0.0 || is_without_effect(campaign.plant, key)) continue;
      number.source_text = fmt::format("default: {}", reason_of_default(key));
    }
    used.numbers.push_back(std::move(number));
  }
  return used;
}

std::vector<std::string> stated_effects(const Campaign& campaign) {
  std::vector<std::string> lines;
  if (campaign.model.empty()) return lines;
  const auto document = parse_config_file(campaign.model.string());
  const auto* table = document.root.find("effects");
  if (table == nullptr) return lines;
  const auto& effects =
      std::visit([](const auto& plant) -> const BeliefEffects& { return plant.effects; }, campaign.belief);
  for (const auto& node : table->children) {
    std::vector<std::string> parameters;
    for (const auto& [name, value] : effects.at(node.key))
      parameters.push_back(fmt::format("{} = {:.6g}", name, value));
    lines.push_back(fmt::format("effects.\"{}\": {} ({}, line {})", node.key, fmt::join(parameters, ", "),
                                campaign.model.filename().string(), node.key_position.line));
  }
  return lines;
}

namespace {

// Another laboratory's robot with numbers of this project's robot in it: a note that lists them.
std::vector<Finding> unstated_hopper(const Campaign& campaign) {
  const auto lines = lines_of(campaign.model);
  std::vector<std::string> missing;
  for (const auto key : hopper_keys()) {
    if (key == "robot.gear_ratio" || key == "robot.hip_offset_m") continue;  // 1 and 0: nothing is assumed
    const bool in_trials =
        std::ranges::all_of(campaign.trials, [&](const CampaignTrial& trial) { return trial.states(key); });
    if (!lines.contains(std::string(key)) && !in_trials) missing.emplace_back(key);
  }
  const bool foreign_columns =
      std::ranges::any_of(campaign.trials, [](const CampaignTrial& trial) { return !trial.columns.empty(); });
  if (missing.empty() || !foreign_columns) return {};
  return {{FindingKind::set_up, FindingSeverity::note,
           (campaign.model.empty() ? campaign.file : campaign.model).string(), 1, 1, missing.front(),
           fmt::format("{} of {} numbers that decide a hopper's answer are those of this project's robot: {}",
                       missing.size(), hopper_keys().size(), fmt::join(missing, ", ")),
           "write your own numbers into nominal.toml"}};
}

}  // namespace

std::vector<Finding> missing_numbers(const Campaign& campaign) {
  std::vector<Finding> missing;
  if (campaign.plant == CampaignPlant::hopper) return unstated_hopper(campaign);
  const auto lines = lines_of(campaign.model);
  for (const auto& [key, value] : numbers_of(campaign.belief)) {
    const bool is_elsewhere =
        key == "terrain.stiffness_N_per_m" && lines.contains("terrain.stiffness_per_area_N_per_m3");
    const bool in_trials =
        std::ranges::all_of(campaign.trials, [&](const CampaignTrial& trial) { return trial.states(key); });
    if (!is_needed(key) || lines.contains(key) || is_elsewhere || in_trials) continue;
    missing.push_back({FindingKind::set_up, FindingSeverity::trial_unusable,
                       (campaign.model.empty() ? campaign.file : campaign.model).string(), 1, 1, key,
                       fmt::format("is stated nowhere, and plant \"{}\" needs it", name_of(campaign.plant)),
                       campaign.model.empty() ? "write your own number into nominal.toml, and model = "
                                                "\"nominal.toml\" into campaign.toml"
                                              : "write your own number"});
  }
  return missing;
}

std::vector<Finding> placeholder_notes(const Campaign& campaign,
                                       const std::function<bool(std::string_view key)>& is_used) {
  if (campaign.plant == CampaignPlant::hopper) return missing_numbers(campaign);
  const auto numbers = numbers_of(campaign.belief);
  std::vector<Finding> notes;
  for (auto& finding : missing_numbers(campaign)) {
    if (!is_used(finding.channel)) continue;
    finding.severity = FindingSeverity::note;
    finding.what = fmt::format(
        "is stated nowhere, and {:.6g} {} is no more than a placeholder: what is "
        "computed with it is wrong by as much as your rig differs",
        numbers.at(finding.channel), unit_of_key(finding.channel));
    notes.push_back(std::move(finding));
  }
  return notes;
}

std::vector<Finding> unused_key_notes(const Campaign& campaign) {
  const auto lines = lines_of(campaign.model);
  std::vector<Finding> notes;
  for (const auto& key : belief_keys(campaign.plant)) {
    const auto line = lines.find(key.path());
    if (key.used || line == lines.end()) continue;
    const auto alike = keys_alike(campaign.plant, key.table, key.key);
    const bool has_other = std::ranges::any_of(
        alike, [&](const std::string& other) { return lines.contains(key.table + "." + other); });
    if (alike.empty() || has_other) continue;
    notes.push_back({FindingKind::set_up, FindingSeverity::note, campaign.model.string(), line->second, 1,
                     key.path(), "is read, but nothing is computed with it",
                     key_in_its_place(campaign.plant, key.table, key.key)});
  }
  return notes;
}

double usual_error(const UsedNumber& n) {
  constexpr double kGravityOverTheEarth_mps2 = 0.027;  // 9.780 at the equator to 9.832 at the poles (WGS 84)
  const double size = std::max(std::abs(n.low), std::abs(n.high));
  if (n.source == UsedNumber::Source::plant_default)
    return n.key == "gravity_mps2" ? kGravityOverTheEarth_mps2 : size;
  return n.written_error > 0.0 ? n.written_error : half_of_last_digit(size);
}

std::vector<KeySpread> rounding_of(const UsedNumbers& used, const Campaign& campaign) {
  std::vector<KeySpread> rounding;
  const auto is_said = [&](const std::string& key) {
    return std::visit(
        [&](const auto& plant) {
          return std::ranges::count(plant.known_to, key, &KeySpread::key) +
                     std::ranges::count(plant.key_spreads, key, &KeySpread::key) >
                 0;
        },
        campaign.belief);
  };
  for (const auto& n : used.numbers) {
    if (n.source != UsedNumber::Source::model_file || n.value == std::round(n.value) ||
        n.key.starts_with("sensors.") || states_uncertainty(n.key) || is_said(n.key))
      continue;
    rounding.push_back({n.key, n.key, usual_error(n) / std::sqrt(3.0), false});
  }
  return rounding;
}

bool is_listed(const UsedNumber& n) {
  return n.source != UsedNumber::Source::plant_default || !is_of_sensors(n.key);
}

std::string defaults_of_sensors(const UsedNumbers& used) {
  std::vector<std::string> lines;
  for (const auto& n : used.numbers)
    if (!is_listed(n))
      lines.push_back(fmt::format("{} = {:.6g}{}{}", n.key, n.value, n.unit.empty() ? "" : " ", n.unit));
  return lines.empty() ? ""
                       : fmt::format("of this project's sensors and trials, because you state none: {}",
                                     fmt::join(lines, ", "));
}

std::string to_string(const UsedNumber& n) {
  const std::string value =
      n.low == n.high ? fmt::format("{:.6g}", n.low) : fmt::format("{:.6g} to {:.6g}", n.low, n.high);
  return fmt::format("{} = {}{}{} ({})", n.key, value, n.unit.empty() ? "" : " ", n.unit, n.source_text);
}

bool is_replaced(std::string_view path, const Belief& belief) {
  if (path != "terrain.stiffness_N_per_m") return false;
  const auto numbers = numbers_of(belief);
  const auto per_area = numbers.find("terrain.stiffness_per_area_N_per_m3");
  return per_area != numbers.end() && per_area->second > 0.0;
}

}  // namespace sandhopper
