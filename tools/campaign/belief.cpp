#include "tools/campaign/belief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "config/load.hpp"
#include "tools/campaign/belief_sources.hpp"
#include "tools/campaign/key_reference.hpp"

namespace sandhopper {
namespace {

template <HasFields Table>
std::vector<std::string> keys_of(const Table& table) {
  std::vector<std::string> keys;
  Table::fields(table, [&](std::string_view key, const auto&, Range = {}) { keys.emplace_back(key); });
  return keys;
}

// Removes from `table` the keys that are not in `known`, with a note for each.
void leave_out_unknown(ConfigNode& table, const std::vector<std::string>& known, const std::string& file,
                       CampaignPlant plant, std::vector<Finding>& notes) {
  std::erase_if(table.children, [&](const ConfigNode& child) {
    if (std::find(known.begin(), known.end(), child.key) != known.end()) return false;
    notes.push_back(
        {.kind = FindingKind::set_up,
         .severity = FindingSeverity::note,
         .file = file,
         .line = child.key_position.line,
         .column = child.key_position.column,
         .channel = table.key + "." + child.key,
         .what = fmt::format("key '{}' is not known in [{}] and is not used", child.key, table.key),
         .cure = key_in_its_place(plant, table.key, child.key)});
    return true;
  });
}

// Removes every `key = "?"` (written by a draft for a number that nobody stated) and lists it.
void leave_out_unstated(ConfigNode& table, const std::string& path, const std::string& file,
                        std::vector<UnstatedNumber>& unstated) {
  std::erase_if(table.children, [&](ConfigNode& child) {
    const auto key = path.empty() ? child.key : path + "." + child.key;
    if (child.kind == ConfigNode::Kind::table) leave_out_unstated(child, key, file, unstated);
    if (child.kind != ConfigNode::Kind::text || child.text != kUnknownNumber) return false;
    unstated.push_back({key, file, child.key_position});
    return true;
  });
}

// Takes the table [known_to] out of the document. A name that means no number of the plant, or several, is a
// problem.
std::vector<KeySpread> take_known_to(ConfigNode& root, const std::map<std::string, double>& numbers,
                                     const std::string& file, std::vector<ConfigProblem>& problems) {
  std::vector<KeySpread> known;
  std::erase_if(root.children, [&](ConfigNode& table) {
    if (table.kind != ConfigNode::Kind::table || table.key != "known_to") return false;
    known = take_key_spreads(table, {}, numbers, file, problems);
    for (const auto& left : table.children)
      problems.push_back(
          {file, left.key_position, "known_to." + left.key,
           fmt::format("known_to.{}: names no number of this belief; write the number's name, or its "
                       "name without the unit and '_relative' for a share of it",
                       left.key)});
    return true;
  });
  return known;
}

template <class Plant>
Belief read_belief(const std::filesystem::path& file, Plant base, std::vector<Finding>& notes,
                   std::vector<UnstatedNumber>& unstated) {
  auto document = parse_config_file(file.string());
  leave_out_unstated(document.root, "", file.string(), unstated);
  std::vector<ConfigProblem> problems;
  const auto plant = static_cast<CampaignPlant>(Belief(base).index());
  for (auto& table : document.root.children) {
    if (table.kind != ConfigNode::Kind::table) continue;
    if (table.key == "sensors") leave_out_unknown(table, keys_of(base.sensors), file.string(), plant, notes);
    if (table.key != "spread") continue;
    const auto known = keys_of(base.spread);
    base.key_spreads = take_key_spreads(table, known, numbers_of(Belief(base)), file.string(), problems);
    leave_out_unknown(table, known, file.string(), plant, notes);
  }
  base.known_to = take_known_to(document.root, numbers_of(Belief(base)), file.string(), problems);
  auto effects = take_effects(document, problems);
  if (!problems.empty()) throw ConfigError(problems);
  auto belief = load_document<Plant>(document, MissingKeys::use_default, std::move(base));
  belief.effects = std::move(effects);
  return belief;
}

// Reads `value` into the first number with its name, table by table. [spread] is skipped.
template <HasFields T>
bool set_named(T& table, const ConfigNode& value, ConfigReader& reader) {
  bool found = false;
  T::fields(table, [&]<class Member>(std::string_view key, Member& member, Range range = {}) {
    if (found || key == "spread") return;
    if constexpr (HasFields<Member>) {
      found = set_named(member, value, reader);
    } else if (key == value.key) {
      reader.read(value, value.key, member, range);
      found = true;
    }
  });
  return found;
}

bool is_diameter(std::string_view key) {
  return std::ranges::find(kDiameterKeys, key) != kDiameterKeys.end();
}

// Radius or area that a diameter gives on this plant; empty if the plant has none.
std::optional<ConfigNode> from_diameter(CampaignPlant plant, const ConfigNode& value) {
  ConfigNode node = value;
  const double diameter_m =
      value.kind == ConfigNode::Kind::integer ? static_cast<double>(value.integer) : value.real;
  node.kind = ConfigNode::Kind::real;
  switch (plant) {
    case CampaignPlant::hopper:
      node.key = "foot_radius_m";
      node.real = 0.5 * diameter_m;
      return node;
    case CampaignPlant::intruder:
      node.key = "radius_m";
      node.real = 0.5 * diameter_m;
      return node;
    case CampaignPlant::falling_body:
      node.key = "frontal_area_m2";
      node.real = 0.25 * std::numbers::pi * diameter_m * diameter_m;
      return node;
    case CampaignPlant::rotary_axis:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

BeliefSensors BeliefSensors::without_effect() {
  BeliefSensors sensors;
  SensorConfig::fields(sensors.robot, [](std::string_view key, double& value, Range range = {}) {
    // Rates, bandwidths and ranges go to their upper limit, disturbances to zero.
    const bool limits = key.ends_with("_Hz") || key.ends_with("_range_mps2");
    value = limits ? range.high : 0.0;
  });
  return sensors;
}

BeliefSpread BeliefSpread::without_effect() {
  BeliefSpread spread;
  SpreadConfig::fields(spread.robot, [](std::string_view key, double& value, Range = {}) {
    if (key != "bed_fluctuation_length_m") value = 0.0;
  });
  return spread;
}

WorldConfig HopperBelief::world() const {
  return {.gravity_mps2 = gravity_mps2,
          .robot = robot,
          .motor = motor,
          .controller = controller,
          .terrain = terrain,
          .sensors = sensors.robot,
          .spread = spread.robot};
}

Belief default_belief(CampaignPlant plant) {
  switch (plant) {
    case CampaignPlant::hopper:
      return HopperBelief{};
    case CampaignPlant::intruder:
      return IntruderBelief{};
    case CampaignPlant::falling_body:
      return FallingBodyBelief{};
    case CampaignPlant::rotary_axis:
      return RotaryAxisBelief{};
  }
  return HopperBelief{};
}

Belief belief_of_silence(CampaignPlant plant) {
  Belief belief = default_belief(plant);
  const auto quiet = [](BedParameters& bed) {
    bed.intercept_depth_m = 0.0;
    bed.added_mass_factor = bed.drag_factor = 0.0;
    bed.unloading_stiffness_ratio = 1.0;
    bed.unloading_damping_ratio = 0.0;
  };
  if (auto* intruder = std::get_if<IntruderBelief>(&belief)) quiet(intruder->terrain);
  if (auto* hopper = std::get_if<HopperBelief>(&belief)) {
    quiet(hopper->terrain);
    hopper->robot.rail_coulomb_N = hopper->robot.joint_coulomb_Nm = hopper->robot.cogging_amplitude_Nm = 0.0;
    const auto none = BeliefSensors::without_effect().robot;
    hopper->sensors.robot.encoder_velocity_bandwidth_Hz = none.encoder_velocity_bandwidth_Hz;
    hopper->sensors.robot.imu_rate_Hz = none.imu_rate_Hz;
  }
  return belief;
}

Belief load_belief(const std::filesystem::path& file, CampaignPlant plant, std::vector<Finding>& notes,
                   std::vector<UnstatedNumber>& unstated) {
  return std::visit([&](auto base) { return read_belief(file, std::move(base), notes, unstated); },
                    belief_of_silence(plant));
}

Finding finding_of(const UnstatedNumber& number, bool is_needed) {
  const auto line = static_cast<std::uint64_t>(number.position.line);
  return {.kind = FindingKind::set_up,
          .severity = is_needed ? FindingSeverity::trial_unusable : FindingSeverity::note,
          .file = number.file,
          .line = line,
          .column = static_cast<std::uint64_t>(number.position.column),
          .channel = {},
          .what = fmt::format("{} = \"{}\" in line {}: {}", number.key, kUnknownNumber, line,
                              is_needed ? "write your own number" : "is not needed here and not used"),
          .cure = is_needed ? "or state it in every trial" : ""};
}

bool override_belief(Belief& belief, const ConfigNode& setup_value, const std::string& file,
                     std::vector<ConfigProblem>& problems) {
  using Kind = ConfigNode::Kind;
  ConfigNode value = setup_value;
  const bool is_number = value.kind == Kind::real || value.kind == Kind::integer;
  if (is_number && is_diameter(value.key)) {
    const auto given = from_diameter(static_cast<CampaignPlant>(belief.index()), value);
    if (!given) return false;
    value = *given;
  }
  ConfigReader reader(file, MissingKeys::use_default);
  const bool found = std::visit([&](auto& table) { return set_named(table, value, reader); }, belief);
  for (auto& problem : reader.take_problems()) problems.push_back(std::move(problem));
  return found;
}

}  // namespace sandhopper
