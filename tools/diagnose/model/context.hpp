#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/key_spread.hpp"

namespace sandhopper::diagnose {

enum class PlantKind : std::uint8_t { falling_body, rotary_axis, intruder, hopper };

// What the simulation believes: every number of nominal.toml under "table.key"; a key that is absent is "no
// such effect".
class Belief {
 public:
  double value(const std::string& key, double otherwise = 0.0) const {
    const auto it = numbers.find(key);
    return it == numbers.end() ? otherwise : it->second;
  }
  bool has(const std::string& key) const { return numbers.contains(key); }

  std::map<std::string, double> numbers;
  // Effects already in place, "port.effect" or "port.effect[channel]" with their parameters (tools/campaign).
  std::map<std::string, std::map<std::string, double>> effects{};
  // Numbers that differ from trial to trial by more than a plant knows by itself.
  std::vector<KeySpread> key_spreads{};
};

// What a recorded channel looks like over the whole campaign.
struct ChannelScale {
  double low = 0.0, high = 0.0;
  double noise_rms = 0.0;      // of one sample, from its own fast fluctuation
  double step_s = 1e-3;        // median time between samples
  double share_at_high = 0.0;  // samples that sit exactly on the largest and smallest value
  double share_at_low = 0.0;
  double grid = 0.0;  // least step between values that differ
};

// A plant's sizes, from the recordings and the belief: effects take their typical sizes from them. A size
// that a plant does not have keeps its default.
struct PlantFacts {
  double weight_N = 1.0, force_N = 1.0, torque_Nm = 1.0;
  double speed_mps = 1.0, speed_radps = 1.0;
  double angle_rad = 1.0;  // range of the motion
  bool moves = true;       // false: an axis that is held still, which shows no friction
  bool masses_differ = false;
  double depth_m = 0.04, foot_radius_m = 0.04;  // of a foot in the bed
  double foot_radius_ratio = 1.0;               // largest to smallest
  double range_of_pushes = 0.0, range_of_wait_s = 0.0;
  std::optional<double> floor_distance_m{};  // least that was left under the foot
  bool position_is_out_of_time = false;
  double wetted_over_m = 0.0;  // length of a body that meets a liquid
  double temperature_K = 0.0;  // of the hottest motor over that of a room
  std::vector<double> ripple_orders{};
};

// What an effect may know when it says what it would look like in this campaign.
struct Context {
  PlantKind plant{};
  Belief belief;
  std::map<std::string, ChannelScale> channels;  // those that are predicted
  PlantFacts facts{};

  bool has(const std::string& channel) const { return channels.contains(channel); }
};

}  // namespace sandhopper::diagnose
