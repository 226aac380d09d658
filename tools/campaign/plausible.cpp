#include "tools/campaign/plausible.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

using enum CampaignPlant;
using enum FindingSeverity;

constexpr double kLongestBed_m = 5.0;
constexpr std::string_view kDrive = "MIT protocol of the drives: a position is coded over +-12.5 rad";
constexpr std::string_view kJoint =
    "MIT protocol of the drives: a speed is coded over +-65 rad/s at most; three times that";
constexpr std::string_view kImu =
    "the widest shock accelerometers of such rigs carry 2000 m/s2 (200 g); ten times that";
constexpr std::string_view kTall = "a leg of 0.4 m in a laboratory";

constexpr std::array kBounds{
    PlausibleBound{intruder, "foot_z_m", kLongestBed_m, "no bed of a laboratory is deeper or higher"},
    PlausibleBound{intruder, "foot_velocity_mps", 10.0, "free fall from 5 m"},
    PlausibleBound{intruder, "foot_accel_mps2", 2e4, kImu},
    PlausibleBound{intruder, "force_N", 1e6, "the frame of a large testing machine"},
    PlausibleBound{falling_body, "accel_mps2", 1e5, "a steel ball on steel: 10,000 g"},
    PlausibleBound{falling_body, "pressure_Pa", 1e7, "a depth of 1000 m of water"},
    PlausibleBound{rotary_axis, "velocity_radps", 2000.0, "a rotor at 19,000 rpm"},
    PlausibleBound{rotary_axis, "torque_Nm", 1e5, "the range of the largest shaft torque sensors"},
    PlausibleBound{hopper, "motor_left_position_rad", 12.5, kDrive},
    PlausibleBound{hopper, "motor_right_position_rad", 12.5, kDrive},
    PlausibleBound{hopper, "motor_left_velocity_radps", 200.0, kJoint},
    PlausibleBound{hopper, "motor_right_velocity_radps", 200.0, kJoint},
    PlausibleBound{hopper, "motor_left_current_A", 500.0, "ten times the peak current of drives of a few kW"},
    PlausibleBound{hopper, "motor_right_current_A", 500.0,
                   "ten times the peak current of drives of a few kW"},
    PlausibleBound{hopper, "tof_height_m", 10.0, kTall},
    PlausibleBound{hopper, "mocap_body_z_m", 10.0, kTall},
    PlausibleBound{hopper, "mocap_foot_z_m", 10.0, kTall},
    PlausibleBound{hopper, "load_cell_force_N", 1e5, "a hundred times the weight of a robot of 100 kg"},
    PlausibleBound{hopper, "imu_body_accel_z_mps2", 2e4, kImu},
    PlausibleBound{hopper, "imu_foot_accel_z_mps2", 2e4, kImu}};

// The trial's belief, if it is of this plant.
template <class T>
const T* belief_of(const CampaignTrial& trial) {
  return std::get_if<T>(&trial.belief);
}

double gravity_of(const Belief& belief) {
  return std::visit([](const auto& plant) { return plant.gravity_mps2; }, belief);
}

double largest(std::span<const double> values) {
  double most = 0.0;
  for (const double value : values)
    if (!std::isnan(value)) most = std::max(most, std::abs(value));
  return most;
}

class PlausibilityChecker {
 public:
  PlausibilityChecker(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places)
      : recording_(recording), campaign_(campaign), trial_(trial), places_(places) {}

  void run() {
    check_bounds();
    if (!recording_.has_time) return;
    check_clock();
  }
  void check_forces() {
    if (campaign_.plant == intruder && trial_.kind != TrialKind::clamped) check_overburden();
  }

 private:
  bool is_stated(std::string_view channel) const { return places_.is_stated(channel); }

  std::string cure(std::string_view channel) const {
    const auto* column = places_.column_of(channel);
    return column == nullptr ? "correct its scale" : scale_cure(*column);
  }

  void check_bounds() {
    for (const auto& bound : kBounds) {
      if (bound.plant != campaign_.plant || !recording_.has(bound.channel)) continue;
      const double most = bound_of(bound);
      const double value = largest(recording_.channel(bound.channel));
      if (value <= most) continue;
      add(bound.channel,
          fmt::format("reaches {:.4g}, which is not plausible: {} ({:.4g})", value, bound.source, most),
          is_stated(bound.channel));
    }
  }

  // Limit of a channel; for the depth at least twice the stated depth of the bed.
  double bound_of(const PlausibleBound& bound) const {
    if (bound.channel != "foot_z_m") return bound.most;
    return std::max(bound.most, 2.0 * trial_.number("bed_depth_m").value_or(0.0));
  }

  // Reports times in ms, us or ns (also as s since 1970) that are taken as s.
  void check_clock() {
    if (recording_.t_s.size() < 10) return;
    constexpr double kNow_s = 1.7e9;  // s since 1970, in 2023
    const double first = std::abs(recording_.t_s.front());
    for (const double unit : {1e3, 1e6, 1e9})
      if (first > 0.5 * kNow_s * unit && first < 3.0 * kNow_s * unit) {
        add("t_s",
            fmt::format("begins at {:.6g}, which is an epoch in {}, not in s", first,
                        unit == 1e3   ? "ms"
                        : unit == 1e6 ? "us"
                                      : "ns"),
            is_stated("t_s"), time_cure(1.0 / unit));
        return;
      }
    const double step_s =
        (recording_.t_s.back() - recording_.t_s.front()) / static_cast<double>(recording_.t_s.size() - 1);
    const bool moves = campaign_.plant == hopper && trial_.kind == TrialKind::hop;
    if (moves && step_s > 0.5)
      add("t_s", fmt::format("a row comes every {:.3g} s, and a hop takes less than a second", step_s),
          is_stated("t_s"), "if the times are in ms " + time_cure(0.001));
  }
  std::string time_cure(double factor) const {
    const auto* time = places_.column_of("t_s");
    return time == nullptr
               ? ""
               : fmt::format("write {} into [columns]", mapping_line(in_other_unit(*time, factor)));
  }

  // rho g z A is the weight of the displaced material. A foot at rest in a bed cannot be pushed with less.
  void check_overburden() {
    const auto* belief = belief_of<IntruderBelief>(trial_);
    const bool has_foot = trial_.states_diameter() || trial_.number("radius_m") || !campaign_.model.empty();
    if (belief == nullptr || !has_foot || !recording_.has("foot_z_m") || !recording_.has("force_N")) return;
    double deepest_m = 0.0;
    for (const double z : recording_.channel("foot_z_m"))
      if (!std::isnan(z)) deepest_m = std::max(deepest_m, -z);
    constexpr double kLightest_kg_per_m3 = 100.0;  // expanded polystyrene beads, cork
    const double area_m2 = std::numbers::pi * belief->foot.radius_m * belief->foot.radius_m;
    const double least_N = kLightest_kg_per_m3 * 9.81 * deepest_m * area_m2;
    const double peak_N = largest(recording_.channel("force_N"));
    if (peak_N <= 0.0 || peak_N >= 0.2 * least_N) return;
    add("force_N",
        fmt::format("reaches {:.3g} N at a depth of {:.3g} m, where even a bed of {:.0f} kg/m3 weighs {:.3g} "
                    "N above a "
                    "foot of {:.3g} m: force, depth or foot is in another unit",
                    peak_N, deepest_m, kLightest_kg_per_m3, least_N, 2.0 * belief->foot.radius_m),
        is_stated("force_N") && is_stated("foot_z_m"));
  }

  void add(std::string_view channel, std::string what, bool stated, std::string how = "") {
    doubt_column(recording_, places_, stated, channel, std::move(what),
                 how.empty() ? cure(channel) : std::move(how));
  }

  TrialRecording& recording_;
  const Campaign& campaign_;
  const CampaignTrial& trial_;
  const RecordingPlaces& places_;
};

// True for the gravity on the Earth's surface (9.764 to 9.834, WGS 84 with its anomalies), Moon, Mars,
// Mercury, Titan, Venus, Jupiter (NASA Planetary Fact Sheet), and 0.
bool is_known_gravity(double g) {
  constexpr std::array kElsewhere{0.0, 1.62, 3.7, 3.71, 3.72, 3.73, 1.35, 8.87, 24.8, 24.79};
  return (g > 9.7 && g < 9.9) || std::any_of(kElsewhere.begin(), kElsewhere.end(),
                                             [&](double other) { return std::abs(g - other) < 0.006; });
}

std::string text_of_gravity(double g) {
  if (std::abs(g - 1.0) < 0.05) return "1 g is 9.81 m/s2";
  return "on Earth it is 9.78 to 9.83 m/s2";
}

void check_density(const FallingBodyBelief& belief, std::vector<Finding>& out, const std::string& file) {
  constexpr double kDensest_kg_per_m3 = 22600.0;  // osmium
  constexpr double kDropped_kg = 25.0;            // Most that a person may lift, ISO 11228-1 (2021).
  constexpr double kLightest_kg_per_m3 = 0.08;    // hydrogen in a laboratory, the lightest gas
  constexpr double kLongest = 30.0;               // Length / diameter of the most slender penetrometers.
  const double area_m2 = belief.body.frontal_area_m2;
  const double length_m = kLongest * std::sqrt(4.0 * area_m2 / std::numbers::pi);
  const double volume_m3 = belief.body.volume_m3 > 0.0 ? belief.body.volume_m3 : area_m2 * length_m;
  const double mass_kg = belief.body.mass_kg;
  const auto add = [&](std::string what) {
    out.push_back({FindingKind::implausible, note, file, 0, 0, "body.mass_kg", std::move(what),
                   "is it in g? write it in kg"});
  };
  const double medium = belief.medium.density_kg_per_m3;
  if (medium > 0.0 && medium < kLightest_kg_per_m3)
    out.push_back({FindingKind::implausible, note, file, 0, 0, "medium.density_kg_per_m3",
                   fmt::format("{:.4g} kg/m3 is lighter than any gas in a laboratory", medium),
                   fmt::format("is it in g/cm3? write density_kg_per_m3 = {:.4g}", 1e3 * medium)});
  if (volume_m3 > 0.0 && mass_kg > kDensest_kg_per_m3 * volume_m3)
    add(fmt::format("{:.4g} kg in {:.3g} m3 at most is denser than any metal", mass_kg, volume_m3));
  else if (mass_kg > kDropped_kg)
    add(fmt::format("a body of {:.4g} kg is not dropped by hand", mass_kg));
}

}  // namespace

std::span<const PlausibleBound> plausible_bounds() { return kBounds; }

void check_plausible(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                     const RecordingPlaces& places) {
  PlausibilityChecker(recording, campaign, trial, places).run();
}

void check_overburden(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                      const RecordingPlaces& places) {
  PlausibilityChecker(recording, campaign, trial, places).check_forces();
}

std::vector<Finding> implausible_beliefs(const Campaign& campaign) {
  std::vector<Finding> out;
  const std::string file = campaign.model.empty() ? campaign.file.string() : campaign.model.string();
  const auto look = [&](const Belief& belief) {
    const double g = gravity_of(belief);
    if (!is_known_gravity(g))
      out.push_back({FindingKind::implausible, note, file, 0, 0, "gravity_mps2",
                     fmt::format("{:.4g} m/s2 is the gravity of no place: {}", g, text_of_gravity(g)),
                     "correct it, or leave it so if the rig is inclined or counterbalanced"});
    if (const auto* body = std::get_if<FallingBodyBelief>(&belief)) check_density(*body, out, file);
  };
  look(campaign.belief);
  for (const auto& trial : campaign.trials) look(trial.belief);
  std::vector<Finding> once;
  for (auto& finding : out)
    if (std::find(once.begin(), once.end(), finding) == once.end()) once.push_back(std::move(finding));
  return once;
}

}  // namespace sandhopper
