#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

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

// What an effect may know when it says what it would look like in this campaign.
struct Context {
  PlantKind plant{};
  Belief belief;
  std::map<std::string, ChannelScale> channels;  // those that are predicted
  std::map<std::string, double> scales;          // of the plant: weight_N, speed_mps, …; see plants/

  bool has(const std::string& channel) const { return channels.contains(channel); }
  double scale(const std::string& name, double otherwise = 1.0) const {
    const auto it = scales.find(name);
    return it == scales.end() ? otherwise : it->second;
  }
};

}  // namespace sandhopper::diagnose
