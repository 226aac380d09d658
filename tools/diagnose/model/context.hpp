#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/key_spread.hpp"

namespace sandhopper::diagnose {

// Step of derivatives by the height of a bed's surface: of the nuisance, and of effects that act as it does.
inline constexpr double kSurfaceStep_m = 1e-4;
// The same for a bed's stiffness, as a share of it. Wide: the jumps at a hopper's events are small against
// the change over such a step; against a quarter of it they are not.
inline constexpr double kStiffnessStep = 4e-3;

enum class PlantKind : std::uint8_t { falling_body, rotary_axis, intruder, hopper };

// The believed model: every number of nominal.toml under "table.key". An absent key takes the caller's
// default, which mostly means that the effect is not modelled.
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
  // Numbers that are known to within a standard deviation only, and the same in all trials.
  std::vector<KeySpread> known_to{};
};

// Samples at a limit that lies before the noise are spread over this many standard deviations.
inline constexpr double kNoiseBand = 6.0;

// Range, noise and resolution of one recorded channel over the whole campaign.
struct ChannelScale {
  double low = 0.0, high = 0.0;
  double noise_rms = 0.0;       // standard deviation of one sample, from fluctuation_rms (plants/inputs.hpp)
  double step_s = 1e-3;         // median time between samples
  double share_at_high = 0.0;   // share of the samples that equal `high`
  double share_at_low = 0.0;    // share of the samples that equal `low`
  double share_near_end = 0.0;  // share of the samples within kNoiseBand noise_rms of the largest magnitude
  double grid = 0.0;            // smallest change between successive samples: the sensor's resolution
};

// Least periods of cogging per revolution: the least common multiple of slots and poles, of a motor with
// three slots and two poles.
inline constexpr double kFewestRipples = 6.0;

// The same for recordings over this range of angles. A ripple is a law that repeats: where less than two
// periods were seen, it is any smooth function of the angle.
inline double fewest_ripples_over(double range_rad) {
  return range_rad > 0.0 ? std::max(kFewestRipples, 4.0 * std::numbers::pi / range_rad) : kFewestRipples;
}

// Characteristic sizes of the plant in this campaign, from the recordings and the belief. Effects scale the
// typical values of their parameters by them. A size that does not apply to a plant keeps its default.
struct PlantFacts {
  double weight_N = 1.0, force_N = 1.0, torque_Nm = 1.0;
  double speed_mps = 1.0, speed_radps = 1.0;
  double angle_rad = 1.0;  // largest |angle| of a rotary axis; range of a leg's angle
  bool is_driven = true;   // false: no trial of an axis has a torque of its drive
  bool moves = true;       // false: the axis is held still, so its friction is not observable
  bool masses_differ = false;
  bool rises_and_falls = false;                         // a body moves through its medium in both directions
  double depth_m = 0.04, foot_radius_m = 0.04;          // depth in the bed; radius of the foot
  double foot_radius_ratio = 1.0;                       // largest to smallest radius over the trials
  double range_of_pushes = 0.0, range_of_wait_s = 0.0;  // largest minus smallest value of the set-up
  double most_pushes = 0.0, longest_wait_s = 0.0;       // largest value of the set-up
  std::optional<double> floor_distance_m{};  // smallest distance of the foot from the floor of the container
  bool position_is_out_of_time = false;      // see intruder_motion.hpp
  double wetted_over_m = 0.0;                // length of a body that enters a liquid; 0: none does
  double temperature_K = 0.0;                // hottest motor above 25 C
  std::vector<double> ripple_orders{};       // candidates for periods per revolution of a torque ripple
  double fewest_ripples = kFewestRipples;    // least number of them: `fewest_ripples_over` the angles
};

// Input of an effect: from it the effect derives its parameters and their typical sizes.
struct Context {
  PlantKind plant{};
  Belief belief;
  std::map<std::string, ChannelScale> channels;  // predicted channels whose recordings vary
  PlantFacts facts{};

  bool has(const std::string& channel) const { return channels.contains(channel); }
};

}  // namespace sandhopper::diagnose
