#include "tools/diagnose/plants/falling_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/falling_body_recording.hpp"
#include "tools/diagnose/plants/ground_laws.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kSpeedOfAThrow_mps = 3.0;  // release speed where nothing is known of it
constexpr double kKnownHeight_m = 0.01;     // release height as an experimenter reads it off
constexpr double kKnownSpeed_mps = 0.02;
constexpr double kReleaseTime_s = 0.03;  // of a release seen in the recording
constexpr double kTouchdownTime_s = 0.1;
constexpr double kKink_s = 4e-3;  // around touchdown, where no sampled signal follows the force's kink
constexpr double kTouchdownAgrees_s =
    1e-4;                                  // instant at which the fall ends and that at which the bed begins
constexpr double kUnknownScale = 0.04;     // of a height recorded nobody says how, its own in each trial
constexpr double kUnknownImpact_m = 0.05;  // of a stop that is simulated apart from its fall
constexpr double kUnknownImpact_mps = 0.3;
constexpr double kUnknownBias_mps2 = 0.08;
constexpr double kLongestRow_s = 4e-3;
constexpr double kSinks = 0.5;       // of the speed of a free fall
constexpr double kUnknownBed = 0.3;  // of its stiffness from place to place
constexpr double kLanded = 4.0;      // standard deviations of the height's noise
constexpr double kLetGo_s = 0.05;    // after a release that only the fall's growth shows
enum Phase : std::uint32_t { kHeld, kSlow, kFast, kBed };

struct Figures {
  double gravity_mps2, mass_kg, area_m2, volume_m3, density_kg_per_m3, drag_coefficient,
      linear_drag_N_s_per_m, buoyancy_factor, added_mass_factor, surface_height_m, bed_stiffness_N_per_m;

  Figures(const Belief& belief, const Edits& edits) {
    const auto read = [&](const char* key, double otherwise) {
      return edits.edited(key, belief.value(key, otherwise));
    };
    gravity_mps2 = read("gravity_mps2", 9.81);
    mass_kg = std::max(1e-9, read("body.mass_kg", 1.0));
    area_m2 = read("body.frontal_area_m2", 0.0);
    volume_m3 = read("body.volume_m3", 0.0);
    density_kg_per_m3 = read("medium.density_kg_per_m3", 0.0);
    drag_coefficient = read("medium.drag_coefficient", 0.0);
    linear_drag_N_s_per_m = read("medium.linear_drag_N_s_per_m", 0.0);
    buoyancy_factor = read("medium.buoyancy_factor", 0.0);
    added_mass_factor = read("medium.added_mass_factor", 0.0);
    surface_height_m = read("bed.surface_height_m", 0.0);
    bed_stiffness_N_per_m = read("bed.stiffness_N_per_m", 0.0);
  }
};

// Body in a medium, perhaps onto a bed:
//   (m + C_m rho V) h'' = -m g + B rho V g - 1/2 rho A C_d |h'| h' - b h' + F_bed + laws
// The instant of touchdown is seen in the recording and fitted on its own; that the fall ends at that instant
// is one row more. So a fall that is some milliseconds too long does not hide the whole bed from the fit.
struct Motion {
  Signal height, velocity, accel;
  double touchdown_s = 0.0;  // when the fall reaches the surface
};

class FallingTrial final : public TrialModel {
 public:
  FallingTrial(const Trial& trial, const Belief& belief) : belief_(belief) {
    name = trial.name;
    payload_kg_ = trial.setup_or("payload_kg", 0.0);
    const auto heights = without_repeats(samples_of(trial, "height_m"));
    // Fast rows say the same thing many times; a stop of some tenths of a second needs no more than this.
    height_told_ = trial.setup.contains("release_height_m");
    const bool height_known = !heights.empty() || height_told_;
    const auto recorded = without_repeats(samples_of(trial, "accel_mps2"));
    const auto accels = height_known ? recorded : averaged(recorded, kLongestRow_s);
    bed_ = belief.value("bed.stiffness_N_per_m") > 0.0;
    end_s_ = trial.time_s.empty() ? 0.0 : trial.time_s.back();
    double step_s = 5e-3;
    for (const auto* s : {&heights, &accels})
      if (!s->empty()) step_s = std::min(step_s, median_step_s(s->time_s));
    step_s_ = std::clamp(step_s, bed_ ? 2.5e-4 : 5e-4, bed_ ? 5e-4 : 5e-3);
    find_release(heights, accels);
    if (bed_ && held_ && !height_known) find_stop(accels);
    place(trial, heights);
    if (bed_ && impact_s_ < 0.0) find_touchdown(heights, accels);
    height_jitter_s_ = jitter_s(heights.time_s, median_step_s(trial.time_s));
    if (!bed_)
      landed_after_s_ = landed_after_s(heights, belief.value("sensors.height_noise_m")).value_or(1e300);
    add_rows(0, heights);
    add_rows(1, accels);
    if (touchdown_nuisance_ >= 0) rows.push_back({2, 0, kBed, touchdown_s_, 0.0});
    if (heights.empty() && start_speed_mps_ < 0.0 && impact_s_ < 0.0) choose_direction();
    label_rows();
  }

  void predict(const Edits& edits, std::span<const double> nuisances, std::span<double> out) const override {
    Motion motion = simulate(edits, nuisances);
    const Figures f(belief_, edits);
    for (double& a : motion.accel.values) a += f.gravity_mps2;
    observe(motion.height, height_sensor_, edits, "height_m", height_times_, out.first(height_times_.size()));
    const auto accels = out.subspan(height_times_.size(), accel_times_.size());
    observe(motion.accel, accel_sensor_, edits, "accel_mps2", accel_times_, accels);
    if (impact_s_ >= 0.0) read_stop(edits, nuisances, f, out);
    if (height_scale_ >= 0)
      for (double& h : out.first(height_times_.size()))
        h += nuisances[index(height_scale_)] * (h - start_height_m_);
    if (touchdown_nuisance_ >= 0)
      out.back() = motion.touchdown_s - touchdown_s_ - nuisances[index(touchdown_nuisance_)];
    if (height_bias_ >= 0)
      for (double& h : out.first(height_times_.size())) h += nuisances[index(height_bias_)];
    if (accel_bias_ >= 0)
      for (double& a : accels) a += nuisances[index(accel_bias_)];
  }

 private:
  static std::size_t index(int nuisance) { return static_cast<std::size_t>(nuisance); }
  void read_stop(const Edits& edits, std::span<const double> nuisances, const Figures& f,
                 std::span<double> out) const {
    Motion stop = simulate(edits, nuisances, true);
    for (double& a : stop.accel.values) a += f.gravity_mps2;
    const auto first = static_cast<std::size_t>(
        std::lower_bound(accel_times_.begin(), accel_times_.end(), impact_s_) - accel_times_.begin());
    observe(stop.accel, accel_sensor_, edits, "accel_mps2", std::span(accel_times_).subspan(first),
            out.subspan(height_times_.size() + first));
  }

  // How fast it is believed to speed up when it is let go: slowly in a liquid.
  double released_mps2() const {
    constexpr double kSlowest = 0.05;  // of free fall
    const Figures f(belief_, {});
    const double mass_kg = f.mass_kg + payload_kg_, fluid_kg = f.density_kg_per_m3 * f.volume_m3;
    const double share =
        std::abs(mass_kg - f.buoyancy_factor * fluid_kg) / (mass_kg + f.added_mass_factor * fluid_kg);
    return f.gravity_mps2 * std::clamp(share, kSlowest, 1.0);
  }

  // The recording may begin while the body is still held.
  void find_release(const Samples& heights, const Samples& accels) {
    const double g = belief_.value("gravity_mps2", 9.81);
    auto found_s = release_before_shock_s(accels, g);
    if (!found_s) found_s = end_of_rest_s(heights, belief_.value("sensors.height_noise_m"), released_mps2());
    held_ = found_s.has_value();
    release_s_ = found_s.value_or(0.0);
    if (held_ || !accels.empty() || height_told_) return;
    if (const auto let_go_s = release_by_hand_s(heights)) {
      release_s_ = *let_go_s + kLetGo_s;
      held_ = from_release_ = true;
    }
  }

  void find_stop(const Samples& accels) {
    const double g = belief_.value("gravity_mps2", 9.81);
    const auto peak_s = hardest_deceleration_s(accels, g);
    if (!peak_s) return;
    stop_s_ = *peak_s;
    const auto impact = find_impact(accels, *peak_s, release_s_, g);
    if (!impact) return;
    impact_s_ = impact->time_s;
    impact_speed_mps_ = impact->speed_mps;
    fall_speed_mps_ = impact->fall_speed_mps;
    release_s_ = impact->fall_from_s;
    from_release_ = true;
  }

  // The first steep rise of the force on the body, or the first height below the surface. On the bed the body
  // stops with a jump that a fit cannot follow smoothly: rows end shortly before.
  void find_touchdown(const Samples& heights, const Samples& accels) {
    constexpr double kShareOfRise = 0.3, kWindow_s = 2e-3, kLastPhase_rad = 1.15;
    const Figures f(belief_, {});
    const Motion fall = simulate({}, std::vector<double>(nuisance_count(), 0.0));
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
      if (accels.time_s[i] > release_s_ + 0.2 * fall.touchdown_s &&
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
    touchdown_s_ = found_s;
    touchdown_nuisance_ = static_cast<int>(trial_nuisances.size());
    trial_nuisances.push_back({"touchdown_time_s", kTouchdownTime_s, 2e-5});
  }

  void place(const Trial& trial, const Samples& heights) {
    const double spread_height = belief_.value("spread.release_height_m");
    const double spread_speed = belief_.value("spread.release_speed_mps");
    const bool told = height_told_;
    double seen = 0.0;
    if (from_release_) {
      seen = on_grid(heights, release_s_, step_s_, 1, false).values[0];
    } else if (!heights.empty()) {
      const std::size_t n = std::min<std::size_t>(heights.value.size(), 3);
      for (std::size_t i = 0; i < n; ++i) seen += heights.value[i] / static_cast<double>(n);
    }
    start_height_m_ = told ? trial.setup_or("release_height_m", 0.0) : seen;
    // Downward, as one writes it down for a drop, unless the heights rise (or the air says so:
    // choose_direction).
    const double told_mps =
        std::abs(trial.setup_or("release_speed_mps", trial.setup_or("impact_speed_mps", 0.0)));
    const bool rises = heights.value.size() > 5 && heights.value[5] > heights.value[0];
    start_speed_mps_ = rises ? told_mps : -told_mps;
    if (impact_s_ >= 0.0) start_speed_mps_ = fall_speed_mps_;
    const double noise = std::max(fluctuation_rms(heights), belief_.value("sensors.height_noise_m"));
    double height_sd = spread_height > 0.0 && told ? spread_height : std::max(kKnownHeight_m, noise);
    // What is written down refers to another zero, or nothing is written down: the recording decides.
    if (!told || (!heights.empty() && std::abs(seen - start_height_m_) > 0.2 + 8.0 * height_sd)) {
      if (!heights.empty()) start_height_m_ = seen;
      height_sd = 1.0;
    }
    double speed_sd = spread_speed > 0.0 ? spread_speed : told ? kKnownSpeed_mps : kSpeedOfAThrow_mps;
    if (held_ && !from_release_) speed_sd = std::min(speed_sd, 0.1);
    if (impact_s_ >= 0.0) speed_sd = kUnknownImpact_mps;
    trial_nuisances.push_back({"release_height_m", height_sd, 1e-4});
    trial_nuisances.push_back({"release_speed_mps", speed_sd, 1e-4});
    if (held_ && !from_release_) {
      release_nuisance_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"release_time_s", kReleaseTime_s, 1e-4});
    }
    if (const double sd = belief_.value("spread.height_bias_m"); sd > 0.0 && !heights.empty()) {
      height_bias_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"height_bias_m", sd, 1e-3});
    }
    // A camera's scale hangs on where it stands and where the body falls.
    const double scale_sd = belief_.value(
        "spread.height_scale_relative",
        belief_.value("sensors.height_noise_m") > 0.0 || trial.find("accel_mps2") ? 0.0 : kUnknownScale);
    if (scale_sd > 0.0 && !heights.empty()) {
      height_scale_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"height_scale_relative", scale_sd, 1e-3});
    }
    // Nothing is told of a sensor that stands alone: its zero may be off as those of such sensors are.
    const bool told_of_accel = belief_.value("sensors.accel_noise_mps2") > 0.0 || impact_s_ < 0.0;
    const double bias_sd =
        std::max(belief_.value("spread.accel_bias_mps2"), told_of_accel ? 0.0 : kUnknownBias_mps2);
    if (const double sd = bias_sd; sd > 0.0 && trial.find("accel_mps2")) {
      accel_bias_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"accel_bias_mps2", sd, 1e-2});
    }
    if (bed_) {
      bed_nuisance_ = static_cast<int>(trial_nuisances.size());
      const double unknown = impact_s_ >= 0.0 ? kUnknownBed : 1e-3;
      trial_nuisances.push_back({"bed_stiffness_relative",
                                 std::max(belief_.value("spread.bed_stiffness_relative"), unknown), 1e-3});
      trial_nuisances.push_back(
          {"surface_height_m", std::max(belief_.value("spread.surface_height_m"), 1e-3), 1e-4});
    }
    if (impact_s_ >= 0.0) {
      impact_nuisance_ = static_cast<int>(trial_nuisances.size());
      trial_nuisances.push_back({"impact_height_m", kUnknownImpact_m, 1e-3});
      trial_nuisances.push_back({"impact_speed_mps", kUnknownImpact_mps, 1e-2});
    }
    height_sensor_ = sensor_belief(belief_, "height", "m");
    accel_sensor_ = sensor_belief(belief_, "accel", "mps2");
  }

  void add_rows(std::uint32_t channel, const Samples& samples) {
    auto& times = channel == 0 ? height_times_ : accel_times_;
    for (std::size_t i = 0; i < samples.value.size(); ++i) {
      if (from_release_ && samples.time_s[i] < release_s_) continue;
      if (samples.time_s[i] > stop_s_ ||
          (channel == 0 && may_have_landed(samples.time_s[i], samples.value[i])))
        break;
      if (channel == 1 && touchdown_nuisance_ >= 0 && std::abs(samples.time_s[i] - touchdown_s_) < kKink_s)
        continue;
      times.push_back(samples.time_s[i]);
      rows.push_back({channel, 0, kSlow, samples.time_s[i], samples.value[i]});
    }
  }

  // Without heights only what the air does tells a throw upwards from one downwards: the simulation that
  // comes clearly nearer.
  void choose_direction() {
    constexpr double kClearly = 0.7;  // of the squares
    const std::vector<double> nothing(nuisance_count(), 0.0);
    std::vector<double> predicted(rows.size());
    const auto squares = [&] {
      predict({}, nothing, predicted);
      double sum = 0.0;
      for (std::size_t k = 0; k < rows.size(); ++k) sum += std::pow(rows[k].measured - predicted[k], 2);
      return sum;
    };
    const double down = squares();
    start_speed_mps_ = -start_speed_mps_;
    if (!(squares() < kClearly * down)) start_speed_mps_ = -start_speed_mps_;
  }

  // Heights are over the ground where a release's is: within their noise of it the body may lie there.
  bool may_have_landed(double time_s, double height_m) const {
    if (time_s > landed_after_s_) return true;
    return height_told_ && !bed_ && height_m < kLanded * belief_.value("sensors.height_noise_m");
  }

  void label_rows() {
    const std::vector<double> nothing(nuisance_count(), 0.0);
    Motion motion = simulate({}, nothing);
    if (impact_s_ >= 0.0) {
      const Motion stop = simulate({}, nothing, true);
      const auto first = std::min(motion.height.values.size(), static_cast<std::size_t>(impact_s_ / step_s_));
      for (std::size_t i = first; i < motion.height.values.size(); ++i) {
        motion.height.values[i] = stop.height.values[i];
        motion.velocity.values[i] = stop.velocity.values[i];
      }
    }
    double fastest = 0.0;
    for (const double v : motion.velocity.values) fastest = std::max(fastest, std::abs(v));
    Coordinate height{"height_m", {}}, velocity{"velocity_mps", {}}, time{"t_s", {}};
    const double surface_m = belief_.value("bed.surface_height_m");
    const double noise_m = belief_.value("sensors.height_noise_m");
    for (Row& row : rows) {
      height.values.push_back(motion.height.at(row.time_s));
      velocity.values.push_back(motion.velocity.at(row.time_s));
      if (row.channel == 0 && noise_m > 0.0)
        row.relative_sd = std::hypot(1.0, velocity.values.back() * height_jitter_s_ / noise_m);
      time.values.push_back(row.time_s);
      row.phase = held_ && row.time_s < release_s_                   ? kHeld
                  : bed_ && height.values.back() <= surface_m        ? kBed
                  : std::abs(velocity.values.back()) < 0.5 * fastest ? kSlow
                                                                     : kFast;
    }
    coordinates = {std::move(velocity), std::move(height), std::move(time)};
  }

  // Going down the body is always where the bed is untouched; added mass is not modelled here.
  static double bed_force_N(const Figures& f, const GroundLaws& ground, double depth_m, double speed_mps) {
    if (depth_m <= 0.0) return 0.0;
    const double quasi_static_N = f.bed_stiffness_N_per_m * depth_m;
    if (ground.empty()) return quasi_static_N;
    const double static_N = ground.quasi_static_N(quasi_static_N, depth_m);
    const BedContact contact{
        .depth_m = depth_m, .speed_mps = speed_mps, .max_depth_m = depth_m, .damping_mass_kg = 0.0};
    return std::max(0.0, static_N + ground.added(contact, static_N, static_N, true).force_N);
  }

  Motion simulate(const Edits& edits, std::span<const double> nuisances, bool stop = false) const {
    Figures f(belief_, edits);
    f.mass_kg += payload_kg_;
    if (bed_nuisance_ >= 0) {
      f.bed_stiffness_N_per_m *= 1.0 + nuisances[index(bed_nuisance_)];
      f.surface_height_m += nuisances[index(bed_nuisance_) + 1];
    }
    const auto laws = edits.at("body");
    const GroundLaws ground(edits);
    const double inertia_kg = f.mass_kg + f.added_mass_factor * f.density_kg_per_m3 * f.volume_m3;
    const double constant_N =
        (-f.mass_kg + f.buoyancy_factor * f.density_kg_per_m3 * f.volume_m3) * f.gravity_mps2;
    const double quadratic = 0.5 * f.density_kg_per_m3 * f.area_m2 * f.drag_coefficient;
    double release_s = release_s_;
    if (stop) release_s = impact_s_;
    if (release_nuisance_ >= 0) release_s += nuisances[index(release_nuisance_)];
    const bool told = touchdown_nuisance_ >= 0;  // when the bed begins
    const double told_s = told ? touchdown_s_ + nuisances[index(touchdown_nuisance_)] : 1e300;
    bool on_bed = stop;
    const auto accel = [&](double t, double h, double v) {
      double force_N = constant_N - quadratic * std::abs(v) * v - f.linear_drag_N_s_per_m * v;
      if (bed_ && v < 0.0 && (on_bed || !told)) force_N += bed_force_N(f, ground, f.surface_height_m - h, -v);
      if (!laws.empty())
        force_N += sum_of(laws, {.time_s = t - release_s,
                                 .position = h,
                                 .velocity = v,
                                 .load = f.surface_height_m - h,
                                 .extreme = start_height_m_});
      return force_N / inertia_kg;
    };
    const auto count = static_cast<std::size_t>(std::ceil(end_s_ / step_s_)) + 2;
    Motion m;
    for (Signal* s : {&m.height, &m.velocity, &m.accel}) *s = {0.0, step_s_, std::vector<double>(count, 0.0)};
    constexpr double kFarAbove_m = 1e6;
    struct {
      double t, h, v;
    } s{0.0, start_height_m_ + nuisances[0] + (impact_s_ >= 0.0 ? kFarAbove_m : 0.0),
        start_speed_mps_ + nuisances[1]};
    if (stop) {
      s.h = f.surface_height_m + nuisances[index(impact_nuisance_)];
      s.v = impact_speed_mps_ + nuisances[index(impact_nuisance_) + 1];
    }
    bool falling = !held_, resting = false, reached = false;
    double speed_at_surface_mps = 0.0;
    const auto advance = [&](double dt) {
      const double a1 = accel(s.t, s.h, s.v);
      const double a2 = accel(s.t + 0.5 * dt, s.h + 0.5 * dt * s.v, s.v + 0.5 * dt * a1);
      const double a3 = accel(s.t + 0.5 * dt, s.h + 0.5 * dt * (s.v + 0.5 * dt * a1), s.v + 0.5 * dt * a2);
      const double a4 = accel(s.t + dt, s.h + dt * (s.v + 0.5 * dt * a2), s.v + dt * a3);
      const double before_m = s.h - f.surface_height_m, before_mps = s.v;
      s.h += dt * (s.v + dt * (a1 + a2 + a3) / 6.0);
      s.v += dt * (a1 + 2.0 * (a2 + a3) + a4) / 6.0;
      s.t += dt;
      if (!reached && before_m > 0.0 && s.h <= f.surface_height_m) {
        // Where a parabola through both ends crosses the surface.
        const double a = (s.v - before_mps) / dt;
        const double root = std::sqrt(std::max(0.0, before_mps * before_mps - 2.0 * a * before_m));
        const double part_s = std::clamp(2.0 * before_m / (root - before_mps), 0.0, dt);
        reached = true;
        m.touchdown_s = s.t - dt + part_s;
        speed_at_surface_mps = before_mps + a * part_s;
      }
      resting = bed_ && (on_bed || !told) && s.v >= 0.0 && s.h < f.surface_height_m;
    };
    const auto advance_to = [&](double t, int parts) {
      const double dt = (t - s.t) / parts;
      for (int part = 0; part < parts && !resting; ++part) advance(dt);
    };
    for (std::size_t i = 0; i < count; ++i) {
      const double grid_s = step_s_ * static_cast<double>(i);
      if (!falling && grid_s > release_s) {
        falling = true;
        s.t = std::max(release_s, grid_s - step_s_);
      }
      if (falling && told && !on_bed && grid_s > told_s) {
        // The fall goes on to the surface, be it too late or too early; the bed begins there when it is told.
        if (s.t < told_s) advance_to(told_s, 1);
        for (int more = 0; !reached && more < 4000; ++more) advance(step_s_);
        if (!reached) m.touchdown_s = s.t;
        on_bed = true;
        s = {std::max(told_s, grid_s - step_s_), f.surface_height_m, reached ? speed_at_surface_mps : s.v};
      }
      if (falling && !resting && grid_s > s.t) {
        // The bed begins with a kink: short steps near and in it.
        const bool near_bed =
            bed_ &&
            (on_bed || (!told && s.h + 2.0 * (grid_s - s.t) * std::min(s.v, 0.0) < f.surface_height_m));
        advance_to(grid_s, near_bed ? 5 : 1);
        s.t = grid_s;
      }
      m.height.values[i] = s.h;
      m.velocity.values[i] = falling && !resting ? s.v : 0.0;
      m.accel.values[i] = falling && !resting ? accel(grid_s, s.h, s.v) : 0.0;
    }
    if (!reached && m.touchdown_s == 0.0) m.touchdown_s = end_s_;
    return m;
  }

  Belief belief_;
  double payload_kg_ = 0.0;  // as the experimenter weighed it
  bool bed_ = false;
  bool held_ = false;
  bool height_told_ = false;   // in the set-up
  bool from_release_ = false;  // rows before it are left out
  double release_s_ = 0.0;
  double height_jitter_s_ = 0.0, stop_s_ = 1e300, landed_after_s_ = 1e300;
  int bed_nuisance_ = -1, release_nuisance_ = -1, height_bias_ = -1, height_scale_ = -1, accel_bias_ = -1;
  int touchdown_nuisance_ = -1, impact_nuisance_ = -1;
  double touchdown_s_ = 0.0;
  double impact_s_ = -1.0, impact_speed_mps_ = 0.0, fall_speed_mps_ = 0.0;  // where both are simulated apart
  double start_height_m_ = 0.0, start_speed_mps_ = 0.0;
  double end_s_ = 0.0, step_s_ = 1e-3;
  SensorBelief height_sensor_, accel_sensor_;
  std::vector<double> height_times_, accel_times_;
};

class FallingBody final : public PlantModel {
 public:
  std::vector<std::string> channels() const override { return {"height_m", "accel_mps2", "touchdown_s"}; }
  double form_error() const override { return 1e-3; }
  double least_sd(const std::string& channel) const override {
    return channel == "touchdown_s" ? kTouchdownAgrees_s : 0.0;
  }
  std::vector<std::string> phases() const override { return {"held", "slow_fall", "fast_fall", "bed"}; }

  std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                    std::string& why) const override {
    auto model = std::make_unique<FallingTrial>(trial, belief);
    if (model->rows.size() >= 10) return model;
    why = "fewer than 10 samples of height_m and accel_mps2";
    return nullptr;
  }

  void describe(const std::vector<Trial>& trials, Context& context) const override {
    const auto& b = context.belief;
    const double g = b.value("gravity_mps2", 9.81);
    double longest_s = 0.0, seen_mps = 0.0;
    for (const auto& trial : trials) {
      if (!trial.time_s.empty()) longest_s = std::max(longest_s, trial.time_s.back());
      seen_mps = std::max(seen_mps, fastest_mps(samples_of(trial, "height_m")));
    }
    double drop_m = 0.0;
    if (const auto it = context.channels.find("height_m"); it != context.channels.end())
      drop_m = it->second.high - it->second.low;
    double speed = drop_m > 0.0 ? std::sqrt(2.0 * g * drop_m) : g * longest_s;
    // What sinks slowly is never as fast as a fall from there.
    if (seen_mps > 0.0 && seen_mps < kSinks * speed) speed = seen_mps;
    context.scales["weight_N"] = b.value("body.mass_kg", 1.0) * g;
    context.scales["speed_mps"] = std::max(speed, 0.1);
    context.scales["duration_s"] = longest_s;
    context.scales["masses_differ"] = range_of_setup(trials, "mass_kg");
    if (b.value("bed.stiffness_N_per_m") > 0.0) {
      context.scales["depth_m"] = std::max(
          0.01, std::abs(speed) * std::sqrt(b.value("body.mass_kg", 1.0) / b.value("bed.stiffness_N_per_m")));
      context.scales["foot_radius_m"] =
          std::max(0.01, std::sqrt(b.value("body.frontal_area_m2") / std::numbers::pi));
    }
  }

  std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                  const Edits& edits) const override {
    return doable_drops(*this, recorded, belief, edits);
  }

  std::vector<FreePort> free_ports(const Context& context) const override {
    return {{"body", false, 0.1 * context.scale("weight_N")}};
  }
};

}  // namespace

std::unique_ptr<PlantModel> make_falling_body() { return std::make_unique<FallingBody>(); }

}  // namespace sandhopper::diagnose
