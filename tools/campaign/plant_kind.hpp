#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "config/fields.hpp"

// Plants, kinds of trial, and all channels that a recording may have.
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

// Kind of a trial without `kind`.
TrialKind usual_kind(CampaignPlant plant);

// Says if a channel may keep the same value without being reported as stuck.
enum class MayRest : std::uint8_t {
  never,    // live sensor: noise or motion changes it
  at_zero,  // only at the value 0 (prescribed, or simulated without noise)
  always    // phase, temperature, command, the firmware's own estimates
};

// A channel of a plant, and how it may behave without being reported.
struct ChannelTraits {
  std::string_view name;
  CampaignPlant plant;
  MayRest may_rest = MayRest::never;
  bool has_range = false;  // The sensor can reach the end of its range.
};

std::span<const ChannelTraits> known_channels();
// Channel of that plant; null if there is none. `t_s` belongs to every plant and is not listed.
const ChannelTraits* find_channel(CampaignPlant plant, std::string_view name);
// First plant with a channel of this name.
std::optional<CampaignPlant> plant_with_channel(std::string_view name);

}  // namespace sandhopper
