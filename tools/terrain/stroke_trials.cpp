#include "tools/terrain/stroke_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimation/motion_smoother.hpp"
#include "terrain/joint_fit.hpp"
#include "terrain/series_compliance.hpp"
#include "tools/campaign/early_end.hpp"
#include "tools/campaign/surface_check.hpp"
#include "tools/experiment/statistics.hpp"
#include "tools/terrain/strength_curve.hpp"
#include "tools/terrain/stroke_map.hpp"

namespace sandhopper {
namespace {

constexpr double kSlowestFoot_mps = 0.001;  // a slower foot does not penetrate
constexpr std::size_t kFewestSamples = 10;
constexpr std::size_t kDrawnStrokes = 6;
constexpr std::size_t kDrawnStrokePoints = 160;
constexpr double kStrokeResolution_m = 2e-4;
constexpr double kStrokeUnloadedShare = 0.05;  // of the largest force

using Sample = LoadingSample;

class Stroke {
 public:
  Stroke(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result)
      : belief_(std::get<IntruderBelief>(trial.belief)),
        believed_stiffness_N_per_m_(believed_stiffness_N_per_m(trial)),
        held_out_(trial.flag("held_out").value_or(false)),
        in_(recording),
        out_(result) {}

  void run() {
    if (!in_.has("foot_z_m") || !in_.has("force_N")) {
      out_.ruled_out.push_back(fmt::format("force against depth and speed: {} not recorded",
                                           in_.has("force_N") ? "foot_z_m" : "force_N"));
      return;
    }
    if (!in_.has_time) {
      out_.ruled_out.emplace_back("force against depth and speed: the file has no time, so no speed");
      return;
    }
    find_motion();
    take_forces();
    remove_offset();
    collect();
    if (loading_.size() < kFewestSamples) {
      out_.ruled_out.emplace_back("force against depth and speed: fewer than ten samples at new depths");
      return;
    }
    fit_line();
    fit_joint();
    add_curve();
    add_sums();
    add_unloading();
    draw();
  }

 private:
  // Speed and acceleration as recorded, otherwise derived from other channels.
  void find_motion() {
    const std::vector<double> none(in_.rows(), NAN);
    const auto* speed = in_.find("foot_velocity_mps");
    const auto* accel = in_.find("foot_accel_mps2");
    MotionNoise noise;
    const double camera_m = belief_.sensors.robot.mocap_noise_m;
    noise.position_m = std::max(1e-5, camera_m);
    motion_ = smooth_motion(in_.t_s, in_.channel("foot_z_m"), accel != nullptr ? *accel : none, noise);
    inertia_known_ = accel != nullptr;
    if (speed == nullptr && accel == nullptr)
      out_.ruled_out.emplace_back(
          "drag and added mass to full accuracy: speed is the slope of the depth alone "
          "(foot_velocity_mps and foot_accel_mps2 not recorded)");
    if (!inertia_known_)
      out_.ruled_out.emplace_back("added mass from the acceleration: foot_accel_mps2 not recorded");
    if (speed != nullptr) take_where_recorded(*speed, motion_.velocity_mps);
    fused_ = speed == nullptr && accel != nullptr;
  }

  static void take_where_recorded(const std::vector<double>& recorded, std::vector<double>& values) {
    for (std::size_t row = 0; row < values.size(); ++row)
      if (!std::isnan(recorded[row])) values[row] = recorded[row];
  }

  // Takes the forces between the first and the last recorded depth. Before and after them the smoothed motion
  // goes on at the speed it had, and no depth was measured.
  void take_forces() {
    const auto depth = in_.channel("foot_z_m"), force = in_.channel("force_N");
    force_N_.assign(force.begin(), force.end());
    const auto is_sample = [](double value) { return !std::isnan(value); };
    const auto first = std::ranges::find_if(depth, is_sample);
    const auto last = std::find_if(depth.rbegin(), depth.rend(), is_sample).base();
    const auto from = static_cast<std::size_t>(first - depth.begin());
    const auto to = static_cast<std::size_t>(last - depth.begin());
    for (std::size_t row = 0; row < force_N_.size(); ++row)
      if (row < from || row >= to) force_N_[row] = NAN;
    if (forces_outlast_depths(in_))
      out_.ruled_out.emplace_back(
          "force after the last recorded depth: foot_z_m ends before force_N, and no depth is assumed there");
  }

  // Subtracts the force sensor's reading in the air before the foot first meets the surface.
  void remove_offset() {
    constexpr double kClear_m = 5e-4;
    std::vector<double> in_air;
    for (std::size_t row = 0; row < in_.rows() && motion_.position_m[row] > 0.0; ++row)
      if (motion_.position_m[row] > kClear_m && !std::isnan(force_N_[row])) in_air.push_back(force_N_[row]);
    // Few rows tell an offset only if it is clear beside the noise of a single one.
    if (in_air.empty() || (in_air.size() < kFewestSamples && untared_force_N(in_) == 0.0)) return;
    const double offset_N = mean(in_air);
    for (double& value : force_N_) value -= offset_N;
    add("force_offset_N", offset_N);
  }

  // Collects rows with a fresh force, paired with the motion at the instant of the force.
  void collect() {
    const auto& force = force_N_;
    const double lag_s = 1.0 / (2.0 * std::numbers::pi * belief_.sensors.robot.load_cell_bandwidth_Hz) +
                         belief_.sensors.other.load_cell_latency_s;
    const double yield_m_per_N = belief_.rig.stiffness_N_per_m ? 1.0 / *belief_.rig.stiffness_N_per_m : 0.0;
    double deepest_m = 0.0;
    for (std::size_t row = 0; row < in_.rows(); ++row) {
      if (std::isnan(force[row]) || in_.is_saturated("force_N", row)) continue;
      Sample s{in_.t_s[row], -motion_.position_m[row], -motion_.velocity_mps[row], -motion_.accel_mps2[row],
               force[row]};
      s.depth_m += -s.speed_mps * lag_s - yield_m_per_N * s.force_N;
      s.speed_mps -= s.accel_mps2 * lag_s;
      if (s.depth_m > 0.0 && s.depth_m > deepest_m && s.speed_mps > kSlowestFoot_mps) loading_.push_back(s);
      deepest_m = std::max(deepest_m, s.depth_m);
      path_.push_back(s);
    }
    speed_mps_ = median_speed_mps();
    add("max_depth_m", deepest_m);
    add("intrusion_speed_mps", speed_mps_);
  }

  double median_speed_mps() const {
    std::vector<double> speeds;
    speeds.reserve(loading_.size());
    for (const auto& s : loading_) speeds.push_back(s.speed_mps);
    if (speeds.empty()) return NAN;
    const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
    std::nth_element(speeds.begin(), middle, speeds.end());
    return *middle;
  }

  StiffnessConfig config() const {
    StiffnessConfig config;
    config.max_depth_m = 1.0;  // the foot is carried by a rod; sand above its top is not checked here
    config.min_samples = static_cast<int>(kFewestSamples);
    return config;
  }

  void fit_line() {
    RecursiveRegression line;
    for (const auto& s : loading_) line.add({s.depth_m, s.force_N, 1.0});
    const auto fit = solve_stiffness(line.sums(), config());
    out_.quantities.push_back({"slope_N_per_m", fit.value_N_per_m, fit.standard_error_N_per_m,
                               fit.validity == Validity::valid ? "" : std::string(name_of(fit.validity))});
    add("line_intercept_N", fit.intercept_N);
  }

  void fit_joint() {
    JointRegression regression({}, belief_.foot.radius_m);
    double before_s = loading_.front().t_s;
    for (const auto& s : loading_) {
      regression.add({.depth_m = s.depth_m,
                      .speed_mps = s.speed_mps,
                      .accel_mps2 = inertia_known_ ? s.accel_mps2 : 0.0,
                      .force_N = s.force_N,
                      .leg_rate_mps = 0.0,
                      .since_contact_s = s.t_s - loading_.front().t_s,
                      .duration_s = s.t_s - before_s});
      before_s = s.t_s;
    }
    const auto fit = solve_joint(regression.sums(), config());
    const std::string invalid = fit.validity == Validity::valid ? "" : std::string(name_of(fit.validity));
    out_.quantities.push_back(
        {"stiffness_joint_N_per_m", fit.value_N_per_m, fit.standard_error_N_per_m, invalid});
    out_.quantities.push_back({"intercept_depth_m", fit.intercept_depth_m, NAN, invalid});
    if (speed_mps_ > 0.3)
      out_.quantities.push_back(
          {"added_mass_factor", fit.added_mass_factor, fit.added_mass_factor_sd, invalid});
  }

  // A slow press stores its own curve (press_trials.cpp), from the window in the set-up.
  void add_curve() {
    if (out_.series.contains("press")) return;
    auto loading = loading_;
    if (!inertia_known_)
      for (auto& s : loading) s.accel_mps2 = 0.0;
    keep_curve(curve_of(loading, {.source = CurveSource::rig,
                                  .diameter_m = 2.0 * belief_.foot.radius_m,
                                  .held_out = held_out_,
                                  .believed_stiffness_N_per_m = believed_stiffness_N_per_m_}),
               out_);
  }

  void add_sums() {
    StrokeSums sums;
    for (const auto& s : loading_)
      sums.add({s.depth_m, s.speed_mps, inertia_known_ ? s.accel_mps2 : 0.0, s.force_N});
    out_.series["stroke_sums"] = sums.numbers();
    out_.series["stroke"] = {2.0 * belief_.foot.radius_m, speed_mps_, inertia_known_ ? 1.0 : 0.0,
                             fused_ ? 1.0 : 0.0};
  }

  // From contact to the end of the force.
  std::span<const Sample> in_contact() const {
    const auto peak =
        std::max_element(path_.begin(), path_.end(), [](auto& a, auto& b) { return a.force_N < b.force_N; });
    auto first = std::find_if(path_.begin(), peak, [](auto& s) { return s.depth_m > 0.0; });
    auto last = std::find_if(peak, path_.end(),
                             [&](auto& s) { return s.force_N < kStrokeUnloadedShare * peak->force_N; });
    if (last != path_.end()) ++last;
    return {first, last};
  }

  void add_unloading() {
    const auto contact = in_contact();
    std::vector<double> depth_m, force_N;
    depth_m.reserve(contact.size());
    force_N.reserve(contact.size());
    for (const auto& s : contact) {
      depth_m.push_back(s.depth_m);
      force_N.push_back(s.force_N);
    }
    add("unloading_stiffness_N_per_m", unloading({depth_m, force_N}, kStrokeResolution_m).stiffness_N_per_m);
  }

  void draw() {
    if (out_.index >= kDrawnStrokes) return;
    const auto drawn = in_contact();
    const std::size_t step = std::max<std::size_t>(1, drawn.size() / kDrawnStrokePoints);
    for (std::size_t i = 0; i < drawn.size(); i += step) {
      out_.series["stroke_depth_m"].push_back(drawn[i].depth_m);
      out_.series["stroke_force_N"].push_back(drawn[i].force_N);
    }
  }

  void add(std::string name, double value) {
    if (std::isfinite(value)) out_.quantities.push_back({std::move(name), value});
  }

  const IntruderBelief& belief_;
  double believed_stiffness_N_per_m_;
  bool held_out_;
  const TrialRecording& in_;
  TrialResult& out_;
  SmoothMotion motion_;
  std::vector<double> force_N_;
  bool inertia_known_ = false;
  bool fused_ = false;  // speed was fused from camera and accelerometer
  std::vector<Sample> loading_, path_;
  double speed_mps_ = 0.0;  // median during penetration
};

}  // namespace

bool StrokeTrials::takes(CampaignPlant plant, TrialKind kind) const {
  return plant == CampaignPlant::intruder &&
         (kind == TrialKind::intrusion || kind == TrialKind::press || kind == TrialKind::tap);
}

void StrokeTrials::analyse(const CampaignTrial& trial, const TrialRecording& recording,
                           TrialResult& result) const {
  Stroke(trial, recording, result).run();
}

CampaignConclusions StrokeTrials::conclude(std::span<const TrialResult* const> results) const {
  return conclude_strokes(results);
}

}  // namespace sandhopper
