#include "tools/campaign/key_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "config/hint.hpp"
#include "tools/campaign/belief.hpp"
#include "tools/campaign/belief_notes.hpp"
#include "tools/campaign/key_meanings.hpp"

namespace sandhopper {
namespace {

using Entry = std::pair<std::string_view, std::string_view>;

constexpr std::array kChannelMeanings{
    Entry{"motor_left_position_rad",
          "angle of the left upper link from straight down; grows as the leg shortens"},
    Entry{"motor_right_position_rad", "the same of the right one"},
    Entry{"motor_left_velocity_radps", "its rate, as the drive reports it"},
    Entry{"motor_right_velocity_radps", "its rate, as the drive reports it"},
    Entry{"motor_left_current_A", "current that makes torque (q axis), positive when it shortens the leg"},
    Entry{"motor_right_current_A", "current that makes torque (q axis), positive when it shortens the leg"},
    Entry{"motor_left_temperature_C", "as the drive reports it"},
    Entry{"motor_right_temperature_C", "as the drive reports it"},
    Entry{"command_left_torque_Nm", "torque that was sent to the drive"},
    Entry{"command_right_torque_Nm", "torque that was sent to the drive"},
    Entry{"imu_body_accel_z_mps2", "specific force of the body upward: +9.81 at rest, 0 in free fall"},
    Entry{"imu_foot_accel_z_mps2", "the same of the foot"},
    Entry{"tof_height_m", "height of the hip axis over the undisturbed surface, by time of flight"},
    Entry{"load_cell_force_N", "force of the ground on the foot, compression positive, tare removed"},
    Entry{"mocap_body_z_m", "height of the hip axis over the undisturbed surface, by motion capture"},
    Entry{"mocap_foot_z_m", "height of the sole, by motion capture; 0 at the undisturbed surface"},
    Entry{"phase", "what the controller believed: flight, compression, extension, or 0, 1, 2"},
    Entry{"imu_body_gyro_x_radps", "turning rate of the body"},
    Entry{"imu_body_gyro_y_radps", "turning rate of the body"},
    Entry{"imu_body_gyro_z_radps", "turning rate of the body"},
    Entry{"imu_foot_gyro_x_radps", "turning rate of the foot"},
    Entry{"imu_foot_gyro_y_radps", "turning rate of the foot"},
    Entry{"imu_foot_gyro_z_radps", "turning rate of the foot"},
    Entry{"bus_voltage_V", "supply of the drives"},
    Entry{"estimate_body_z_m", "the firmware's own estimate of the body's height"},
    Entry{"estimate_foot_z_m", "the firmware's own estimate of the sole's height"},
    Entry{"estimate_body_velocity_mps", "the firmware's own estimate of the body's speed upward"},
    Entry{"estimate_foot_velocity_mps", "the firmware's own estimate of the foot's speed upward"},
    Entry{"estimate_contact_force_N", "ground force by the firmware's momentum observer"},
    Entry{"quasi_static_force_N", "ground force from the motors' torque alone, inertia neglected"},
    Entry{"foot_z_m", "height of the plate's face over the undisturbed surface; negative in the bed"},
    Entry{"foot_velocity_mps", "its speed, upward positive"},
    Entry{"foot_accel_mps2", "its acceleration, upward positive, without gravity: 0 at rest"},
    Entry{"force_N", "force of the bed on the plate, compression positive"},
    Entry{"height_m", "height of the body; its zero is free"},
    Entry{"accel_mps2", "specific force upward: +9.81 at rest, 0 in free fall"},
    Entry{"pressure_Pa", "pressure at the body; read and checked, not predicted"},
    Entry{"accel_2_mps2", "a second accelerometer on the same axis, of another range"},
    Entry{"accel_3_mps2", "a third one"},
    Entry{"accel_4_mps2", "a fourth one"},
    Entry{"lateral_x_accel_mps2", "specific force across the axis"},
    Entry{"lateral_y_accel_mps2", "specific force across the axis"},
    Entry{"position_rad", "angle of the output; 0 hangs straight down where gravity acts"},
    Entry{"velocity_radps", "its rate, as the drive reports it"},
    Entry{"torque_Nm", "torque of the drive on the output, as it reports it"},
    Entry{"load_cell_torque_Nm", "torque by a sensor of the bench; read and checked, not predicted"},
};

// In the order of TrialKind.
constexpr std::array<std::string_view, EnumNames<TrialKind>::value.size()> kKindMeanings{
    "the robot is let go, lands, pushes off (hopper)",
    "a plate is pushed into the bed as prescribed (intruder)",
    "a body is let go and falls (falling body)",
    "an axis is driven, or runs free (rotary axis)",
    "the body is clamped and the foot swings in the air (hopper)",
    "nothing moves: the robot stands in the bed, or the drive holds an angle",
    "the body is driven down slowly (hopper); a slow intrusion (intruder)",
    "a short blow on the foot, for the delays between sensors (hopper)",
    "the moving part is blocked: the rig on a rigid stop, the axis held",
};

// In the order of CampaignPlant.
constexpr std::array<std::string_view, EnumNames<CampaignPlant>::value.size()> kPlantMeanings{
    "a one-legged robot on a vertical rail that hops on a bed",
    "a plate or rod that an actuator pushes into a bed",
    "a body that falls through air or a liquid, onto a bed or not",
    "one axis that turns: a motor with a load, a pendulum, a wheel",
};

const KeyMeaning* find_meaning(std::string_view path) {
  for (const auto meanings : {model_key_meanings(), sensor_key_meanings()})
    for (const auto& entry : meanings)
      if (entry.path == path) return &entry;
  return nullptr;
}

struct Collector {
  CampaignPlant plant;
  std::vector<BeliefKey> keys{};

  template <HasFields T>
  void walk(const T& table, const std::string& name) {
    T::fields(table, [&]<class Member>(std::string_view key, const Member& member, Range range = {}) {
      if constexpr (HasFields<Member>)
        walk(member, std::string(key));
      else
        add(name, key, member, range);
    });
  }

  template <class Member>
  void add(const std::string& table, std::string_view key, const Member& value, Range range) {
    BeliefKey entry{table, std::string(key), unit_of_key(key), written(value), range, {}};
    if constexpr (std::is_same_v<Member, bool>) entry.unit = "true or false";
    if (entry.unit.empty()) entry.unit = "1";
    if (const auto* found = find_meaning(entry.path())) {
      entry.meaning = found->meaning;
      const char letter = name_of(plant).front();
      const auto capital = static_cast<char>(std::toupper(letter));
      entry.used = found->plants.empty() || found->plants.find(letter) != std::string_view::npos;
      entry.of_this_plant = entry.used || found->plants.find(capital) != std::string_view::npos;
    }
    entry.is_needed = decides_answer(plant, entry.path());
    keys.push_back(std::move(entry));
  }

  static std::string written(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string("not set");
  }
  template <class Value>
  requires(!std::is_same_v<Value, std::optional<double>>) static std::string written(const Value& value) {
    return fmt::format("{}", value);
  }
};

}  // namespace

std::vector<BeliefKey> belief_keys(CampaignPlant plant) {
  Collector collector{plant};
  std::visit([&](const auto& belief) { collector.walk(belief, ""); }, belief_of_silence(plant));
  return collector.keys;
}

std::vector<std::string> keys_alike(CampaignPlant plant, std::string_view table, std::string_view key) {
  const auto first = key.find('_');
  std::vector<std::string> alike;
  if (first == std::string_view::npos) return alike;
  for (const auto& known : belief_keys(plant))
    if (known.table == table && known.used && known.key != key && known.key.ends_with(key.substr(first)))
      alike.push_back(known.key);
  return alike;
}

std::string key_in_its_place(CampaignPlant plant, std::string_view table, const std::string& key) {
  if (const auto alike = keys_alike(plant, table, key); !alike.empty())
    return fmt::format("plant \"{}\" has {} for it", name_of(plant), either(alike));
  std::vector<std::string> used;
  for (const auto& known : belief_keys(plant))
    if (known.table == table && known.used) used.push_back(known.key);
  const auto cure = cure_for_unknown_key(key, std::nullopt, used);
  return fmt::format("{}{} leave it as it is ('hop campaign keys {}' lists the keys)", cure,
                     cure.ends_with('?') ? " Or" : ", or", name_of(plant));
}

std::string_view meaning_of_key(std::string_view path) {
  const auto* found = find_meaning(path);
  return found == nullptr ? std::string_view{} : found->meaning;
}

std::vector<ChannelEntry> channel_entries(CampaignPlant plant) {
  std::vector<ChannelEntry> entries{{"t_s", "s", "time of the row, from the start of the recording"}};
  for (const auto& channel : known_channels()) {
    if (channel.plant != plant) continue;
    const auto found = std::ranges::find(kChannelMeanings, channel.name, &Entry::first);
    auto unit = unit_of_key(channel.name);
    entries.push_back({channel.name, unit.empty() ? "1" : std::move(unit),
                       found == kChannelMeanings.end() ? std::string_view{} : found->second});
  }
  return entries;
}

std::string_view meaning_of(TrialKind kind) { return kKindMeanings[static_cast<std::size_t>(kind)]; }
std::string_view meaning_of(CampaignPlant plant) { return kPlantMeanings[static_cast<std::size_t>(plant)]; }

}  // namespace sandhopper
