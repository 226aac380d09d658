#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "config/fields.hpp"

// Names of plants, kinds of trial, and every channel a recording may have.
namespace sandhopper {

enum class CampaignPlant : std::uint8_t { hopper, intruder, falling_body, rotary_axis };
template <>
struct EnumNames<CampaignPlant> {
  static constexpr std::array<std::string_view, 4> value{"hopper", "intruder", "falling_body", "rotary_axis"};
};

enum class TrialKind : std::uint8_t { hop, intrusion, drop, motion, air_sweep, hold, press, tap, clamped };
template <>
struct EnumNames<TrialKind> {
  static constexpr std::array<std::string_view, 9> value{"hop",  "intrusion", "drop", "motion", "air_sweep",
                                                         "hold", "press",     "tap",  "clamped"};
};

// What an experimenter on this plant usually does.
TrialKind usual_kind(CampaignPlant plant);

// When the same value over and over is nothing to remark on.
enum class MayRest : std::uint8_t {
  never,    // a live sensor: noise or motion changes it
  at_zero,  // only the value 0 (prescribed, simulated without noise)
  always    // phase, temperature, command, the firmware's own estimates
};

struct ChannelTraits {
  std::string_view name;
  CampaignPlant plant;
  MayRest may_rest = MayRest::never;
  bool has_range = false;  // a sensor that can be driven to the end of its range
};

std::span<const ChannelTraits> known_channels();
// Of that plant; null when there is none. `t_s` belongs to every plant and is not among them.
const ChannelTraits* find_channel(CampaignPlant plant, std::string_view name);
// The first plant that has a channel of this name.
std::optional<CampaignPlant> plant_with_channel(std::string_view name);

}  // namespace sandhopper
