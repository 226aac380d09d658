#include "tools/diagnose/plants/falling_body/falling_trial.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/campaign/belief.hpp"
#include "tools/campaign/rest_before_fall.hpp"
#include "tools/diagnose/plants/falling_body/falling_body_recording.hpp"
#include "tools/diagnose/plants/falling_body/falling_simulation.hpp"
#include "tools/diagnose/plants/falling_body/release_spread.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kSpeedOfAThrow_mps = 3.0;  // standard deviation of a release speed that nothing states
constexpr double kKnownHeight_m = 0.01;     // standard deviation of a release height in the set-up
constexpr double kKnownSpeed_mps = 0.02;  // standard deviation of the release speed, if the height is stated
constexpr double kStatedSpeed = 0.01;     // relative standard deviation of an impact speed in the set-up
constexpr double kReleaseTime_s = 0.03;   // standard deviation of a release that the recording shows
constexpr double kTouchdownTime_s = 0.1;  // standard deviation of a touchdown that the recording shows
constexpr double kKink_s = 4e-3;  // nearer to the touchdown, accelerations are left out: they have a kink
// Relative standard deviation, in each trial, of the scale of an undescribed height sensor.
constexpr double kUnknownScale = 0.04;
// Standard deviations of a stop that is simulated separately from its fall.
constexpr double kUnknownImpact_m = 0.05;
constexpr double kUnknownImpact_mps = 0.3;
constexpr double kUnknownBias_mps2 = 0.08;  // standard deviation of the zero of an undescribed accelerometer
constexpr double kLongestRow_s = 4e-3;      // accelerations without a height are averaged to this
constexpr double kUnknownBed = 0.3;  // relative standard deviation of the bed's stiffness from place to place
// In standard deviations of the height's noise: nearer to the ground the body may lie there.
constexpr double kLanded = 4.0;
constexpr double kLetGo_s = 0.05;  // rows are used from this time after release_by_hand_s() on

constexpr double kLiquid_kg_per_m3 = 100.0;  // gases are lighter, liquids heavier

// Height of the liquid's surface in the belief; empty if the medium is everywhere.
std::optional<double> believed_surface_m(const Belief& belief) {
  const double surface_m = belief.value("medium.surface_height_m", FallingBodyBelief::kEverywhere_m);
  return surface_m < FallingBodyBelief::kEverywhere_m ? std::optional(surface_m) : std::nullopt;
}

// Time at which the body enters a liquid, from the accelerometer.
std::optional<double> entry_of(const Trial& trial, const Belief& belief) {
  if (belief.value("medium.density_kg_per_m3") < kLiquid_kg_per_m3 ||
      belief.value("bed.stiffness_N_per_m") > 0.0)
    return std::nullopt;
  return liquid_entry_s(without_repeats(samples_of(trial, "accel_mps2")), belief.value("gravity_mps2", 9.81));
}

class FallingTrial final : public TrialModel {
 public:
  FallingTrial(const Trial& trial, const Belief& belief) {
    fall_.belief = belief;
    name = trial.name;
    fall_.payload_kg = trial.setup_or("payload_kg", 0.0);
    const auto heights = without_repeats(samples_of(trial, "height_m"));
    // If neither a height nor the entry is known, fast accelerations are averaged: a stop of some tenths of a
    // second needs no faster rows.
    height_is_stated_ = trial.setup.contains("release_height_m");
    const double noise_m = std::max(fluctuation_rms(heights), belief.value("sensors.height_noise_m"));
    ground_is_at_zero_ = height_is_stated_ && !goes_on_below_zero(heights, kLanded * noise_m);
    const bool height_known = !heights.empty() || height_is_stated_;
    const auto recorded = without_repeats(samples_of(trial, "accel_mps2"));
    entry_s_ = entry_of(trial, belief);
    const auto accels = height_known || entry_s_ ? recorded : averaged(recorded, kLongestRow_s);
    if (entry_s_ || believed_surface_m(belief)) fall_.length_m = body_length_m(belief);
    fall_.bed = belief.value("bed.stiffness_N_per_m") > 0.0;
    fall_.end_s = trial.time_s.empty() ? 0.0 : trial.time_s.back();
    double step_s = 5e-3;
    for (const auto* s : {&heights, &accels})
      if (!s->empty()) step_s = std::min(step_s, median_step_s(s->time_s));
    fall_.step_s = std::clamp(step_s, fall_.bed ? 2.5e-4 : 5e-4, fall_.bed ? 5e-4 : 5e-3);
    find_release(trial, heights, accels);
    if (fall_.bed && fall_.held && !height_known) find_stop(accels);
    place(trial, heights);
    if (fall_.bed && fall_.impact_s < 0.0) find_touchdown(heights, accels);
    height_jitter_s_ = jitter_s(heights.time_s, median_step_s(trial.time_s));
    if (!fall_.bed)
      landed_after_s_ = landed_after_s(heights, belief.value("sensors.height_noise_m")).value_or(1e300);
    add_rows(0, heights);
    add_rows(1, accels);
    if (fall_.touchdown_nuisance >= 0) rows.push_back({2, 0, kBed, fall_.touchdown_s, 0.0});
    if (heights.empty() && fall_.start_speed_mps < 0.0 && fall_.impact_s < 0.0 && !entry_s_)
      choose_direction();
    label_rows();
  }

  void predict(const Edits& edits, std::span<const double> nuisances, std::span<double> out) const override {
    FallingMotion motion = fall_.simulate(edits, nuisances);
    const FallingFigures f(fall_.belief, edits);
    for (double& a : motion.accel.values) a += f.gravity_mps2;
    observe(motion.height, height_sensor_, edits, "height_m", height_times_, out.first(height_times_.size()));
    const auto accels = out.subspan(height_times_.size(), accel_times_.size());
    observe(motion.accel, accel_sensor_, edits, "accel_mps2", accel_times_, accels);
    if (fall_.impact_s >= 0.0) read_stop(edits, nuisances, f, out);
    if (height_scale_ >= 0)
      for (double& h : out.first(height_times_.size()))
        h += nuisances[index(height_scale_)] * (h - fall_.start_height_m);
    if (fall_.touchdown_nuisance >= 0)
      out.back() = motion.touchdown_s - fall_.touchdown_s - nuisances[index(fall_.touchdown_nuisance)];
    if (height_bias_ >= 0)
      for (double& h : out.first(height_times_.size())) h += nuisances[index(height_bias_)];
    if (accel_bias_ >= 0)
      for (double& a : accels) a += nuisances[index(accel_bias_)];
  }

 private:
  static std::size_t index(int nuisance) { return static_cast<std::size_t>(nuisance); }
  void read_stop(const Edits& edits, std::span<const double> nuisances, const FallingFigures& f,
                 std::span<double> out) const {
    FallingMotion stop = fall_.simulate(edits, nuisances, true);
    for (double& a : stop.accel.values) a += f.gravity_mps2;
    const auto first = static_cast<std::size_t>(
        std::lower_bound(accel_times_.begin(), accel_times_.end(), fall_.impact_s) - accel_times_.begin());
    observe(stop.accel, accel_sensor_, edits, "accel_mps2", std::span(accel_times_).subspan(first),
            out.subspan(height_times_.size() + first));
  }

  // Believed acceleration after the release; it is small in a liquid.
  double released_mps2() const {
    constexpr double kSlowest = 0.05;  // share of free fall
    const FallingFigures f(fall_.belief, {});
    const double mass_kg = f.mass_kg + fall_.payload_kg, fluid_kg = f.density_kg_per_m3 * f.volume_m3;
    const double share =
        std::abs(mass_kg - f.buoyancy_factor * fluid_kg) / (mass_kg + f.added_mass_factor * fluid_kg);
    return f.gravity_mps2 * std::clamp(share, kSlowest, 1.0);
  }

  // Finds the release. The recording may begin while the body is still held.
  void find_release(const Trial& trial, const Samples& heights, const Samples& accels) {
    const double g = fall_.belief.value("gravity_mps2", 9.81);
    auto found_s = release_before_shock_s(accels, g);
    if (!found_s) found_s = loss_of_weight_s(accels, g);
    if (!found_s)
      found_s = end_of_rest_s(heights, fall_.belief.value("sensors.height_noise_m"), released_mps2());
    if (!found_s && height_is_stated_ && accels.empty() && stated_speed_mps(trial) == 0.0)
      found_s = rest_before_fall_s(heights.time_s, heights.value);
    fall_.held = found_s.has_value();
    fall_.release_s = found_s.value_or(0.0);
    if (fall_.held || !accels.empty() || height_is_stated_) return;
    if (const auto let_go_s = release_by_hand_s(heights)) {
      fall_.release_s = *let_go_s + kLetGo_s;
      fall_.held = from_release_ = true;
    }
  }

  void find_stop(const Samples& accels) {
    const double g = fall_.belief.value("gravity_mps2", 9.81);
    const auto peak_s = hardest_deceleration_s(accels, g);
    if (!peak_s) return;
    stop_s_ = *peak_s;
    const auto impact = find_impact(accels, *peak_s, fall_.release_s, g);
    if (!impact) return;
    fall_.impact_s = impact->time_s;
    fall_.impact_speed_mps = impact->speed_mps;
    fall_speed_mps_ = impact->fall_speed_mps;
    fall_.release_s = impact->fall_from_s;
    from_release_ = true;
  }

  // Finds the touchdown: the first steep rise of the acceleration, else the first height below the surface.
  // On the bed the body stops with a jump that a fit cannot follow, so rows end shortly before.
  void find_touchdown(const Samples& heights, const Samples& accels) {
    // Least share of the believed bed's rise within the window; phase on the bed (it stops at pi / 2).
    constexpr double kShareOfRise = 0.3, kWindow_s = 2e-3, kLastPhase_rad = 1.15;
    const FallingFigures f(fall_.belief, {});
    const FallingMotion fall = fall_.simulate({}, std::vector<double>(nuisance_count(), 0.0));
    double fastest = 0.1;
    for (const double v : fall.velocity.values) fastest = std::max(fastest, -v);
    const double inertia_kg = f.mass_kg + f.added_mass_factor * f.density_kg_per_m3 * f.volume_m3;
    const double rate_radps = std::sqrt(f.bed_stiffness_N_per_m / inertia_kg);
    double found_s = -1.0;
    const double step_s = median_step_s(accels.time_s);
    const auto window = static_cast<std::size_t>(std::max(1.0, std::round(kWindow_s / step_s)));
    const double rise =
        std::max(8.0 * fluctuation_rms(accels),
                 kShareOfRise * rate_radps * rate_radps * fastest * step_s * static_cast<double>(window));
    for (std::size_t i = window + 3; i < accels.value.size() && found_s < 0.0; ++i)
      if (accels.time_s[i] > fall_.release_s + 0.2 * fall.touchdown_s &&
          accels.value[i] - accels.value[i - window] > rise)
        found_s = accels.time_s[i - window];
    bool felt = found_s >= 0.0;
    if (!felt) {
      for (std::size_t i = 0; i < heights.value.size() && found_s < 0.0; ++i)
        if (heights.value[i] < f.surface_height_m) found_s = heights.time_s[i];
      const auto blow_s = gap_around_s(accels, found_s < 0.0 ? fall.touchdown_s : found_s);
      felt = blow_s.has_value();
      found_s = blow_s.value_or(found_s);
    }
    if (felt) stop_s_ = found_s + kLastPhase_rad / rate_radps;
    if (found_s < 0.0) return;
    fall_.touchdown_s = found_s;
    fall_.touchdown_nuisance = static_cast<int>(trial_nuisances.size());
    trial_nuisances.push_back(own_nuisance("touchdown_time_s", kTouchdownTime_s, 2e-5));
  }

  // Start of a fall without recorded heights: at the entry the body is at the surface, with the speed that
  // the set-up states.
  void begin_before_entry(double stated_mps, double& height_sd, double& speed_sd) {
    const double g = fall_.belief.value("gravity_mps2", 9.81);
    const double fall_s = *entry_s_ - (fall_.held ? fall_.release_s : 0.0);
    if (fall_.held || stated_mps == 0.0)
      fall_.start_speed_mps = 0.0;
    else
      fall_.start_speed_mps = g * fall_s - stated_mps;
    if (!fall_.held && stated_mps > 0.0) speed_sd = std::max(kKnownSpeed_mps, kStatedSpeed * stated_mps);
    fall_.start_height_m = fall_.surface_m + fall_s * (0.5 * g * fall_s - fall_.start_speed_mps);
    fall_.to_entry_s = fall_s;
    height_sd = std::max(1e-3, (g * fall_s - fall_.start_speed_mps) * fall_.step_s);
  }

  void place(const Trial& trial, const Samples& heights) {
    const bool stated = height_is_stated_;
    double seen = 0.0;
    if (from_release_) {
      seen = on_grid(heights, fall_.release_s, fall_.step_s, 1, false).values[0];
    } else if (!heights.empty()) {
      const std::size_t n = std::min<std::size_t>(heights.value.size(), 3);
      for (std::size_t i = 0; i < n; ++i) seen += heights.value[i] / static_cast<double>(n);
    }
    fall_.start_height_m = stated ? trial.setup_or("release_height_m", 0.0) : seen;
    // A drop has a positive speed downward in the set-up. It is upward if the heights rise, or if
    // choose_direction() finds so.
    const double stated_mps = std::abs(stated_speed_mps(trial));
    const bool rises = heights.value.size() > 5 && heights.value[5] > heights.value[0];
    fall_.start_speed_mps = rises ? stated_mps : -stated_mps;
    if (fall_.impact_s >= 0.0) fall_.start_speed_mps = fall_speed_mps_;
    const double noise = std::max(fluctuation_rms(heights), fall_.belief.value("sensors.height_noise_m"));
    double height_sd = std::max(kKnownHeight_m, noise);
    if (stated) height_sd = spread_of(fall_.belief, "spread.release_height_m", height_sd);
    // Takes the height from the recording if the set-up has none, or one over another zero.
    if (!stated || (!heights.empty() && std::abs(seen - fall_.start_height_m) > 0.2 + 8.0 * height_sd)) {
      if (!heights.empty()) fall_.start_height_m = seen;
      height_sd = 1.0;
    }
    double speed_sd =
        release_speed_sd_mps(fall_.belief, stated_mps, stated ? kKnownSpeed_mps : kSpeedOfAThrow_mps);
    if (fall_.held && !from_release_) speed_sd = std::min(speed_sd, 0.1);
    if (fall_.impact_s >= 0.0) speed_sd = kUnknownImpact_mps;
    fall_.surface_m = believed_surface_m(fall_.belief).value_or(0.0);
    if (entry_s_) {
      if (!heights.empty() && !believed_surface_m(fall_.belief))
        fall_.surface_m = on_grid(heights, *entry_s_, fall_.step_s, 1, false).values[0];
      if (heights.empty()) begin_before_entry(stated_mps, height_sd, speed_sd);
    }
    add_nuisances(trial, heights, height_sd, speed_sd);
    height_sensor_ = sensor_belief(fall_.belief, "height", "m");
    accel_sensor_ = sensor_belief(fall_.belief, "accel", "mps2");
  }

  // Adds the nuisances of the release, the sensors and the bed.
  void add_nuisances(const Trial& trial, const Samples& heights, double height_sd, double speed_sd) {
    trial_nuisances.push_back(own_nuisance("release_height_m", height_sd, 1e-4));
    trial_nuisances.push_back(own_nuisance("release_speed_mps", speed_sd, 1e-4));
    if (fall_.held && !from_release_) {
      fall_.release_nuisance = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back(own_nuisance("release_time_s", kReleaseTime_s, 1e-4));
    }
    if (const double sd = fall_.belief.value("spread.height_bias_m"); sd > 0.0 && !heights.empty()) {
      height_bias_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"height_bias_m", sd, 1e-3});
    }
    // A camera's scale depends on where it stands and where the body falls.
    const double scale_sd = fall_.belief.value(
        "spread.height_scale_relative",
        fall_.belief.value("sensors.height_noise_m") > 0.0 || trial.find("accel_mps2") ? 0.0 : kUnknownScale);
    if (scale_sd > 0.0 && !heights.empty()) {
      height_scale_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"height_scale_relative", scale_sd, 1e-3});
    }
    // The zero of an accelerometer that is the only sensor, and that the belief does not describe, may be
    // off.
    const bool accel_described = fall_.belief.value("sensors.accel_noise_mps2") > 0.0 || fall_.impact_s < 0.0;
    const double bias_sd =
        spread_of(fall_.belief, "spread.accel_bias_mps2", accel_described ? 0.0 : kUnknownBias_mps2);
    if (const double sd = bias_sd; sd > 0.0 && trial.find("accel_mps2")) {
      accel_bias_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"accel_bias_mps2", sd, 1e-2});
    }
    if (fall_.bed) {
      fall_.bed_nuisance = static_cast<int>(trial_nuisances.size());
      const double unknown = fall_.impact_s >= 0.0 ? kUnknownBed : 1e-3;
      trial_nuisances.push_back({"bed_stiffness_relative",
                                 spread_of(fall_.belief, "spread.bed_stiffness_relative", unknown), 1e-3});
      trial_nuisances.push_back(
          {"surface_height_m", spread_of(fall_.belief, "spread.surface_height_m", 1e-3), 1e-4});
    }
    if (fall_.impact_s >= 0.0) {
      fall_.impact_nuisance = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back(own_nuisance("impact_height_m", kUnknownImpact_m, 1e-3));
      trial_nuisances.push_back(own_nuisance("impact_speed_mps", kUnknownImpact_mps, 1e-2));
    }
  }

  void add_rows(std::uint32_t channel, const Samples& samples) {
    auto& times = channel == 0 ? height_times_ : accel_times_;
    for (std::size_t i = 0; i < samples.value.size(); ++i) {
      if (from_release_ && samples.time_s[i] < fall_.release_s) continue;
      if (samples.time_s[i] > stop_s_ ||
          (channel == 0 && may_have_landed(samples.time_s[i], samples.value[i])))
        break;
      if (channel == 1 && fall_.touchdown_nuisance >= 0 &&
          std::abs(samples.time_s[i] - fall_.touchdown_s) < kKink_s)
        continue;
      times.push_back(samples.time_s[i]);
      rows.push_back({channel, 0, kSlow, samples.time_s[i], samples.value[i]});
    }
  }

  // Chooses between a throw upwards and one downwards. Without heights only the drag shows it: the direction
  // is reversed if the simulation then fits clearly better.
  void choose_direction() {
    constexpr double kClearly = 0.7;  // ratio of the sums of squares
    const std::vector<double> nothing(nuisance_count(), 0.0);
    std::vector<double> predicted(rows.size());
    const auto squares = [&] {
      predict({}, nothing, predicted);
      double sum = 0.0;
      for (std::size_t k = 0; k < rows.size(); ++k) sum += std::pow(rows[k].measured - predicted[k], 2);
      return sum;
    };
    const double down = squares();
    fall_.start_speed_mps = -fall_.start_speed_mps;
    if (!(squares() < kClearly * down)) fall_.start_speed_mps = -fall_.start_speed_mps;
  }

  // With a stated release height, heights count from the ground unless they go on below 0. Within their noise
  // of the ground the body may lie there.
  bool may_have_landed(double time_s, double height_m) const {
    if (time_s > landed_after_s_) return true;
    return ground_is_at_zero_ && !fall_.bed &&
           height_m < kLanded * fall_.belief.value("sensors.height_noise_m");
  }

  // True in the liquid, and up to three rows before the recorded entry, because the simulated one may come
  // earlier.
  bool in_liquid(double time_s, double height_m) const {
    constexpr double kRows = 3.0;
    if (fall_.length_m <= 0.0) return false;
    return height_m <= fall_.surface_m || (entry_s_ && time_s > *entry_s_ - kRows * fall_.step_s);
  }

  void label_rows() {
    const std::vector<double> nothing(nuisance_count(), 0.0);
    FallingMotion motion = fall_.simulate({}, nothing);
    if (fall_.impact_s >= 0.0) {
      const FallingMotion stop = fall_.simulate({}, nothing, true);
      const auto first =
          std::min(motion.height.values.size(), static_cast<std::size_t>(fall_.impact_s / fall_.step_s));
      for (std::size_t i = first; i < motion.height.values.size(); ++i) {
        motion.height.values[i] = stop.height.values[i];
        motion.velocity.values[i] = stop.velocity.values[i];
      }
    }
    double fastest = 0.0;
    for (const double v : motion.velocity.values) fastest = std::max(fastest, std::abs(v));
    Coordinate height{"height_m", {}}, velocity{"velocity_mps", {}}, time{"t_s", {}};
    const double surface_m = fall_.belief.value("bed.surface_height_m");
    const double noise_m = fall_.belief.value("sensors.height_noise_m");
    for (Row& row : rows) {
      height.values.push_back(motion.height.at(row.time_s));
      velocity.values.push_back(motion.velocity.at(row.time_s));
      if (row.channel == 0 && noise_m > 0.0)
        row.relative_sd = std::hypot(1.0, velocity.values.back() * height_jitter_s_ / noise_m);
      time.values.push_back(row.time_s);
      row.phase = fall_.held && row.time_s < fall_.release_s       ? kHeld
                  : fall_.bed && height.values.back() <= surface_m ? kBed
                  : in_liquid(row.time_s, height.values.back())
                      ? (height.values.back() > fall_.surface_m - fall_.length_m ? kEntry : kImmersed)
                  : std::abs(velocity.values.back()) < 0.5 * fastest ? kSlow
                                                                     : kFast;
    }
    coordinates = {std::move(velocity), std::move(height), std::move(time)};
  }

  Fall fall_;
  bool height_is_stated_ = false;  // the set-up states release_height_m
  bool ground_is_at_zero_ = false;
  bool from_release_ = false;  // rows before the release are left out
  double height_jitter_s_ = 0.0, stop_s_ = 1e300, landed_after_s_ = 1e300;
  int height_bias_ = -1, height_scale_ = -1, accel_bias_ = -1;
  double fall_speed_mps_ = 0.0;    // speed after the release, if fall and stop are simulated separately
  std::optional<double> entry_s_;  // entry into a liquid, as the accelerometer shows it
  SensorBelief height_sensor_, accel_sensor_;
  std::vector<double> height_times_, accel_times_;
};

}  // namespace

bool meets_a_liquid(const Trial& trial, const Belief& belief) {
  return believed_surface_m(belief) || entry_of(trial, belief).has_value();
}

std::unique_ptr<TrialModel> make_falling_trial(const Trial& trial, const Belief& belief) {
  return std::make_unique<FallingTrial>(trial, belief);
}

}  // namespace sandhopper::diagnose
