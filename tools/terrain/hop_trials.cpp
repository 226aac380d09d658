#include "tools/terrain/hop_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "terrain/series_compliance.hpp"
#include "tools/experiment/treatments.hpp"
#include "tools/terrain/hop_replay.hpp"
#include "tools/terrain/measured_stride.hpp"
#include "tools/terrain/strength_curve.hpp"

namespace sandhopper {
namespace {

constexpr std::array kWays{StiffnessWay{"quasi_static_ols", "quasi-static, OLS", "orange"},
                           StiffnessWay{"observer_ols", "observer, OLS", "purple"},
                           StiffnessWay{"observer_wls", "observer, weighted", "blue"},
                           StiffnessWay{"joint", "joint fit", "green"},
                           StiffnessWay{"load_cell_ols", "load cell, OLS", "sand"},
                           StiffnessWay{"load_cell_joint", "load cell, joint fit", "grey"}};
constexpr std::size_t kDrawnTrials = 4;  // number of trials whose curves are kept in the result
constexpr std::size_t kDrawnPoints = 160;
constexpr double kUnloadedShare = 0.05;      // of the peak: below it the foot has left the ground
constexpr double kDepthResolution_m = 2e-4;  // resolution of depth on an unloading path

TrialQuantity stiffness(std::string_view way, std::string_view window, const StiffnessEstimate& e) {
  return {stiffness_name(way, window), e.value_N_per_m, e.standard_error_N_per_m,
          e.validity == Validity::valid ? "" : std::string(name_of(e.validity))};
}

TrialQuantity stiffness(std::string_view way, const JointEstimate& e) {
  return {stiffness_name(way, ""), e.value_N_per_m, e.standard_error_N_per_m,
          e.validity == Validity::valid ? "" : std::string(name_of(e.validity))};
}

bool in_stance(State state) { return state == State::compression || state == State::extension; }

StiffnessConfig with_window(const StiffnessConfig& config, const TreatmentCase& definition) {
  auto changed = config;
  changed.window = definition.window;
  changed.free_intercept = definition.free_intercept;
  return changed;
}

// Root mean square.
struct Rms {
  double sum = 0.0;
  std::size_t count = 0;
  void add(double error) {
    if (std::isnan(error)) return;
    sum += error * error;
    ++count;
  }
  double value() const { return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : NAN; }
};

class HopAnalysis {
 public:
  HopAnalysis(const CampaignTrial& trial, const TrialRecording& recording, TrialResult& result)
      : trial_(trial), in_(recording), out_(result), cycle_(cycle_config_for(trial)) {}

  void run() {
    replay();
    measure();
    if (!strides_.empty() && measured_) compare();
    if (strides_.empty() && !measured_)
      out_.ruled_out.emplace_back(
          "stiffness by any treatment: neither the leg's channels nor force and depth are whole");
  }

 private:
  void replay() {
    std::optional<Leg> leg;
    try {
      leg.emplace(cycle_.robot);
    } catch (const std::invalid_argument& error) {
      out_.ruled_out.push_back(fmt::format("force from the motors: {}", error.what()));
      return;
    }
    std::string missing;
    const auto hop = hop_frames(trial_, in_, *leg, missing);
    if (!hop) {
      out_.ruled_out.push_back(fmt::format(
          "force from the motors (quasi-static and momentum observer): {} not recorded", missing));
      return;
    }
    for (const auto& note : hop->notes) out_.ruled_out.push_back(note);
    first_row_ = hop->release_row;
    strides_ = replay_hop(*hop, cycle_, *leg);
    if (strides_.empty() || !strides_.front().complete) {
      out_.ruled_out.emplace_back(
          "stiffness by the firmware's estimators: the recording holds no complete stance");
      strides_.clear();
      return;
    }
    for (auto& stride : strides_) stride.foot = foot_in_flight(cycle_, Leg(cycle_.robot));
    if (!strides_.back().complete) strides_.pop_back();
    add_estimates();
    add_firmware_curve();
  }

  void add_estimates() {
    const auto& stride = strides_.front();
    for (const auto& definition : treatment_cases()) {
      if (definition.true_state) continue;
      const auto result = evaluate_stride(stride, with_window(cycle_.stiffness, definition));
      out_.quantities.push_back(stiffness("quasi_static_ols", definition.name, result.quasi_static_ols));
      out_.quantities.push_back(stiffness("observer_ols", definition.name, result.observer_ols));
      out_.quantities.push_back(stiffness("observer_wls", definition.name, result.observer_wls));
    }
    const auto nominal = evaluate_stride(stride, cycle_.stiffness);
    out_.quantities.push_back(stiffness("joint", nominal.joint));
    const bool joint = nominal.joint.validity == Validity::valid;
    add("added_mass_factor", joint ? nominal.joint.added_mass_factor : NAN,
        nominal.joint.added_mass_factor_sd);
    add("intercept_depth_m", joint ? nominal.joint.intercept_depth_m : NAN);
    add_summary(nominal.summary);
    add("strides", static_cast<double>(strides_.size()));
    if (out_.index < kDrawnTrials) draw(stride, "observer", &Estimate::contact_force_N);
    if (out_.index < kDrawnTrials) draw(stride, "quasi_static", &Estimate::quasi_static_force_N);
  }

  double foot_diameter_m() const { return 2.0 * cycle_.robot.foot_radius_m; }

  // Curve from all strides, as the firmware estimates the ground after the last one. The error of the torque
  // constant is common to all trials.
  void add_firmware_curve() {
    ProfileSolver solver(cycle_.stiffness);
    double greatest_N = 0.0;
    follow_strides(strides_, cycle_.stiffness, [&](const StrideSums& sums) {
      greatest_N = std::max(greatest_N, sums.summary.peak_force_N);
      solver.add(sums.profile, sums.summary.stride);
    });
    keep_curve(curve_of(solver, greatest_N,
                        {.source = CurveSource::firmware,
                         .diameter_m = foot_diameter_m(),
                         .held_out = trial_.flag("held_out").value_or(false),
                         .shared_sd_relative = cycle_.stiffness.joint.force_scale_relative}),
               out_);
  }

  // Curve of the first stance up to its deepest point, from load cell and motion capture.
  void add_measured_curve() {
    std::vector<LoadingSample> loading;
    for (const auto& sample : measured_->stride.samples) {
      const auto& e = sample.estimate;
      if (in_stance(sample.state) && e.force_velocity_mps > cycle_.stiffness.min_speed_mps)
        loading.push_back({static_cast<double>(e.force_time_ns) * 1e-9, e.force_depth_m, e.force_velocity_mps,
                           -e.foot_accel_mps2, e.direct_force_N});
    }
    keep_curve(curve_of(loading, {.source = CurveSource::load_cell,
                                  .diameter_m = foot_diameter_m(),
                                  .held_out = trial_.flag("held_out").value_or(false),
                                  .believed_stiffness_N_per_m =
                                      cycle_.stiffness.profile_or_default().believed_stiffness_N_per_m}),
               out_);
  }

  void add_summary(const StrideSummary& s) {
    const auto seconds = [](std::int64_t from_ns, std::int64_t to_ns) {
      return static_cast<double>(to_ns - from_ns) * 1e-9;
    };
    add("touchdown_speed_mps", s.touchdown_speed_mps);
    add("peak_force_N", s.peak_force_N);
    add("peak_quasi_static_force_N", s.peak_quasi_static_N);
    add("max_depth_m", s.max_depth_m);
    add("liftoff_depth_m", s.liftoff_depth_m);
    if (s.switch_ns > 0) add("compression_s", seconds(s.contact_ns, s.switch_ns));
    if (s.switch_ns > 0) add("extension_s", seconds(s.switch_ns, s.liftoff_ns));
  }

  void measure() {
    std::string missing;
    measured_ = measured_stride(trial_, in_, cycle_.stiffness, missing);
    if (!measured_) {
      out_.ruled_out.push_back(
          fmt::format("comparison with measured force and depth: {} not recorded", missing));
      return;
    }
    if (!measured_->stride.complete) {
      out_.ruled_out.emplace_back(
          "stiffness from load cell and motion capture: no complete stance in the recording");
      measured_.reset();
      return;
    }
    measured_->stride.foot = foot_in_flight(cycle_, Leg(cycle_.robot));
    for (const auto& definition : treatment_cases()) {
      if (definition.true_state) continue;
      if (definition.window == SampleWindow::compression && !measured_->phases_known) continue;
      const auto result = evaluate_stride(measured_->stride, with_window(cycle_.stiffness, definition));
      out_.quantities.push_back(stiffness("load_cell_ols", definition.name, result.observer_ols));
    }
    const auto nominal = evaluate_stride(measured_->stride, cycle_.stiffness);
    out_.quantities.push_back(stiffness("load_cell_joint", nominal.joint));
    if (strides_.empty()) add_summary(nominal.summary);
    add_measured_curve();
    add_unloading();
    if (out_.index < kDrawnTrials) draw(measured_->stride, "load_cell", &Estimate::contact_force_N);
  }

  // Unloading stiffness after the deepest point.
  void add_unloading() {
    std::vector<double> depth_m, force_N;
    double peak_N = 0.0;
    for (const auto& sample : measured_->stride.samples) {
      const auto& e = sample.estimate;
      if (!in_stance(sample.state)) continue;
      peak_N = std::max(peak_N, e.contact_force_N);
      depth_m.push_back(e.force_depth_m);
      force_N.push_back(e.contact_force_N);
      if (force_N.size() > 1 && peak_N > 10.0 && e.contact_force_N < kUnloadedShare * peak_N) break;
    }
    const auto found = unloading({depth_m, force_N}, kDepthResolution_m);
    add("unloading_stiffness_N_per_m", found.stiffness_N_per_m);
  }

  // Compares the estimates with load cell and motion capture, row by row in the first stance.
  void compare() {
    Rms quasi_static, observer;
    std::vector<double> depth_error_m;
    const auto& own = strides_.front().samples;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const std::size_t row = first_row_ + i;
      if (row < measured_->first_row || row - measured_->first_row >= measured_->stride.samples.size())
        continue;
      if (!in_stance(own[i].state)) continue;
      const auto& estimate = own[i].estimate;
      const auto& measured = measured_->stride.samples[row - measured_->first_row].estimate;
      quasi_static.add(estimate.quasi_static_force_N - measured.load_cell_force_N);
      observer.add(estimate.contact_force_N - measured.load_cell_force_N);
      depth_error_m.push_back(measured.foot_z_m - estimate.foot_z_m);
    }
    if (depth_error_m.empty()) return;
    double mean_m = 0.0;
    for (const double error : depth_error_m) mean_m += error / static_cast<double>(depth_error_m.size());
    Rms within;
    for (const double error : depth_error_m) within.add(error - mean_m);
    add("quasi_static_force_error_rms_N", quasi_static.value());
    add("observer_force_error_rms_N", observer.value());
    add("depth_error_mean_m", mean_m);
    add("depth_error_rms_in_stance_m", within.value());
  }

  void add(std::string name, double value, double standard_error = NAN) {
    if (std::isfinite(value)) out_.quantities.push_back({std::move(name), value, standard_error});
  }

  // Stores depth and force of the first stance, thinned, as series "NAME_depth_m" and "NAME_force_N".
  void draw(const RecordedStride& stride, const std::string& name, double Estimate::*force) {
    std::vector<const Estimate*> stance;
    for (const auto& sample : stride.samples)
      if (in_stance(sample.state)) stance.push_back(&sample.estimate);
    const std::size_t step = std::max<std::size_t>(1, stance.size() / kDrawnPoints);
    for (std::size_t i = 0; i < stance.size(); i += step) {
      out_.series[name + "_depth_m"].push_back(stance[i]->force_depth_m);
      out_.series[name + "_force_N"].push_back(stance[i]->*force);
    }
  }

  const CampaignTrial& trial_;
  const TrialRecording& in_;
  TrialResult& out_;
  CycleConfig cycle_;
  std::vector<RecordedStride> strides_;
  std::size_t first_row_ = 0;
  std::optional<MeasuredStride> measured_;
};

}  // namespace

std::span<const StiffnessWay> stiffness_ways() { return kWays; }

std::string stiffness_name(std::string_view way, std::string_view window) {
  return fmt::format("stiffness_{}{}{}_N_per_m", way, window.empty() ? "" : "_", window);
}

bool HopTrials::takes(CampaignPlant plant, TrialKind kind) const {
  return plant == CampaignPlant::hopper && kind == TrialKind::hop;
}

void HopTrials::analyse(const CampaignTrial& trial, const TrialRecording& recording,
                        TrialResult& result) const {
  const auto* belief = std::get_if<HopperBelief>(&trial.belief);
  if (belief != nullptr && belief->terrain.rigid) return;  // a rigid ground has no stiffness to estimate
  HopAnalysis(trial, recording, result).run();
}

CampaignConclusions HopTrials::conclude(std::span<const TrialResult* const> results) const {
  const bool any = std::any_of(results.begin(), results.end(),
                               [](const TrialResult* result) { return !result->quantities.empty(); });
  return any ? conclude_hops(results) : CampaignConclusions{};
}

}  // namespace sandhopper
