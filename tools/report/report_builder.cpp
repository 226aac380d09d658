#include "tools/report/report_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/report/event_text.hpp"

namespace sandhopper {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kHalfCycle_ns = 500'000;

// A channel with one value per cycle, at the cycle's time.
struct CycleChannel {
  const char* name;
  double (*value)(const StepOutput&);
};
template <std::size_t i>
double innovation(const StepOutput& o) {
  return o.estimate.innovation[i];
}
template <std::size_t i>
double normalised(const StepOutput& o) {
  return o.estimate.normalised_innovation_squared[i];
}
double command_torque_Nm(const StepOutput& out) {
  return out.command.motor[0].torque_Nm + out.command.motor[1].torque_Nm;
}
constexpr std::array kCycleChannels{
    CycleChannel{"estimate_leg_length_m", [](const StepOutput& o) { return o.estimate.leg_length_m; }},
    CycleChannel{"estimate_body_z_m", [](const StepOutput& o) { return o.estimate.body_z_m; }},
    CycleChannel{"estimate_foot_z_m", [](const StepOutput& o) { return o.estimate.foot_z_m; }},
    CycleChannel{"estimate_surface_z_m", [](const StepOutput& o) { return o.estimate.surface_z_m; }},
    CycleChannel{"estimate_body_velocity_mps",
                 [](const StepOutput& o) { return o.estimate.body_velocity_mps; }},
    CycleChannel{"estimate_foot_velocity_mps",
                 [](const StepOutput& o) { return o.estimate.foot_velocity_mps; }},
    CycleChannel{"estimate_body_accel_mps2", [](const StepOutput& o) { return o.estimate.body_accel_mps2; }},
    CycleChannel{"estimate_foot_accel_mps2", [](const StepOutput& o) { return o.estimate.foot_accel_mps2; }},
    CycleChannel{"estimate_weighting_accel_mps2",
                 [](const StepOutput& o) { return o.estimate.weighting_accel_mps2; }},
    CycleChannel{"estimate_leg_torque_Nm", [](const StepOutput& o) { return o.estimate.leg_torque_Nm; }},
    CycleChannel{"command_leg_torque_Nm", command_torque_Nm},
    CycleChannel{"innovation_tof_m", innovation<0>},
    CycleChannel{"innovation_leg_length_m", innovation<1>},
    CycleChannel{"innovation_leg_rate_mps", innovation<2>},
    CycleChannel{"normalised_tof", normalised<0>},
    CycleChannel{"normalised_leg_length", normalised<1>},
    CycleChannel{"normalised_leg_rate", normalised<2>},
};

// Channels whose values stand at the time of their own measurement.
enum TimedChannel : std::size_t {
  kContactForce = kCycleChannels.size(),
  kQuasiStaticForce,
  kForceDepth,
  kLoadCell,
  kTof,
  kTruthBody,
  kTruthFoot,
  kTruthBodyVelocity,
  kTruthFootVelocity,
  kTruthBodyAccel,
  kTruthFootAccel,
  kTruthForce,
  kTruthTorque,
  kMocapBody,
  kMocapFoot,
  kChannelCount
};
constexpr std::array kTimedNames{"estimate_contact_force_N",
                                 "quasi_static_force_N",
                                 "force_depth_m",
                                 "load_cell_force_N",
                                 "tof_height_m",
                                 "truth_body_z_m",
                                 "truth_foot_z_m",
                                 "truth_body_velocity_mps",
                                 "truth_foot_velocity_mps",
                                 "truth_body_accel_mps2",
                                 "truth_foot_accel_mps2",
                                 "truth_contact_force_N",
                                 "truth_leg_torque_Nm",
                                 "mocap_body_z_m",
                                 "mocap_foot_z_m"};
static_assert(kTimedNames.size() == kChannelCount - kCycleChannels.size());

std::string in_words(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '_', ' ');
  return text;
}

// A fit without a result leaves its value 0.
double or_none(double value) { return value == 0.0 ? kNone : value; }

// In a crater only the new ground below it counts. Then the reason names the missing new ground, not the
// depth.
std::string reason_of(Validity validity, double crater_depth_m) {
  const bool is_little = validity == Validity::too_shallow || validity == Validity::too_few_samples ||
                         validity == Validity::no_new_penetration;
  if (!is_little || crater_depth_m <= 0.0) return in_words(name_of(validity));
  return fmt::format("too little new ground below the crater of {:.0f} mm", 1e3 * crater_depth_m);
}

ReportStiffness stiffness(const StiffnessEstimate& fit, double crater_depth_m) {
  return {.value_N_per_m = or_none(fit.value_N_per_m),
          .ci95_low_N_per_m = fit.ci95_low_N_per_m,
          .ci95_high_N_per_m = fit.ci95_high_N_per_m,
          .intercept_N = fit.intercept_N,
          .samples = fit.samples,
          .valid = fit.validity == Validity::valid,
          .reason = reason_of(fit.validity, crater_depth_m),
          .standard_error_N_per_m = fit.standard_error_N_per_m};
}

// The page draws this fit as its quasi-static part beyond the first millimetres: F = k (z + z0).
ReportStiffness stiffness(const JointEstimate& fit, double crater_depth_m) {
  return {.value_N_per_m = or_none(fit.value_N_per_m),
          .ci95_low_N_per_m = fit.ci95_low_N_per_m,
          .ci95_high_N_per_m = fit.ci95_high_N_per_m,
          .intercept_N = fit.value_N_per_m * fit.intercept_depth_m,
          .samples = fit.samples,
          .valid = fit.validity == Validity::valid,
          .reason = reason_of(fit.validity, crater_depth_m),
          .standard_error_N_per_m = fit.standard_error_N_per_m};
}

}  // namespace

void ReportBuilder::put(std::size_t channel, std::int64_t time_ns, double value) {
  if (std::isfinite(value)) points_.push_back({channel, time_ns, value});
}

void ReportBuilder::add(const SensorFrame& frame) {
  if (frame.tof.fresh) put(kTof, frame.tof.time_ns, frame.tof.height_m);
  fresh_load_cell_ns_ = frame.load_cell.fresh ? frame.load_cell.time_ns : 0;
}

void ReportBuilder::add(const StepOutput& output) {
  row_ns_.push_back(output.time_ns);
  state_.push_back(output.state);
  // Without an estimate there is nothing to draw: in state idle, and before the zero check has set the leg
  // length.
  if (output.state == State::idle || output.estimate.leg_length_m == 0.0) return;
  for (std::size_t i = 0; i < kCycleChannels.size(); ++i)
    put(i, output.time_ns, kCycleChannels[i].value(output));
  const Estimate& estimate = output.estimate;
  if (estimate.force_time_ns != newest_force_ns_) {
    newest_force_ns_ = estimate.force_time_ns;
    put(kContactForce, newest_force_ns_, estimate.contact_force_N);
    put(kQuasiStaticForce, newest_force_ns_, estimate.quasi_static_force_N);
    put(kForceDepth, newest_force_ns_, estimate.force_depth_m);
  }
  if (fresh_load_cell_ns_ != 0) put(kLoadCell, fresh_load_cell_ns_, estimate.load_cell_force_N);
  fresh_load_cell_ns_ = 0;
}

void ReportBuilder::add(const PlantTruth& truth) {
  put(kTruthBody, truth.time_ns, truth.body_z_m);
  put(kTruthFoot, truth.time_ns, truth.foot_z_m);
  put(kTruthBodyVelocity, truth.time_ns, truth.body_velocity_mps);
  put(kTruthFootVelocity, truth.time_ns, truth.foot_velocity_mps);
  put(kTruthBodyAccel, truth.time_ns, truth.body_accel_mps2);
  put(kTruthFootAccel, truth.time_ns, truth.foot_accel_mps2);
  put(kTruthForce, truth.time_ns, truth.contact_force_N);
  put(kTruthTorque, truth.time_ns, truth.motor_torque_Nm);
  if (truth.mocap_time_ns == newest_mocap_ns_) return;
  newest_mocap_ns_ = truth.mocap_time_ns;
  put(kMocapBody, newest_mocap_ns_, truth.mocap_body_z_m);
  put(kMocapFoot, newest_mocap_ns_, truth.mocap_foot_z_m);
}

void ReportBuilder::add(const Event& event) {
  events_.push_back(event);
  if (event.kind == EventKind::released && !released_) {
    released_ = true;
    zero_ns_ = event.time_ns;
  }
}

void ReportBuilder::add(const StrideResult& stride) {
  strides_.push_back(stride);
  profiles_.emplace_back();
  grounds_.emplace_back();
  ground_events_.emplace_back();
}

void ReportBuilder::add(const StrengthProfile& profile) {
  if (!profiles_.empty()) profiles_.back() = profile;
}

void ReportBuilder::add(const GroundSummary& ground) {
  if (!grounds_.empty()) grounds_.back() = ground;
}

void ReportBuilder::add(const GroundEvents& found) {
  for (std::size_t i = 0; i < strides_.size(); ++i)
    if (strides_[i].summary.stride == found.stride) ground_events_[i] = found;
}

double ReportBuilder::seconds(std::int64_t time_ns) const {
  if (time_ns == 0) return kNone;
  const std::int64_t zero_ns = released_ || row_ns_.empty() ? zero_ns_ : row_ns_.front();
  return 1e-9 * static_cast<double>(time_ns - zero_ns);
}

// The filter's depth at the first contact with the surface, m. The stride summaries count depth from there.
double ReportBuilder::depth_datum_m() const {
  if (strides_.empty()) return 0.0;
  const std::int64_t contact_ns = strides_.front().summary.contact_ns;
  const auto at = std::ranges::find_if(points_, [&](const Point& point) {
    return point.channel == kForceDepth && point.time_ns == contact_ns;
  });
  return at == points_.end() ? 0.0 : at->value;
}

void ReportBuilder::add_columns(ReportData& data) const {
  const double datum_m = depth_datum_m();
  std::vector<std::vector<double>> columns(kChannelCount);
  for (const Point& point : points_) {
    auto row = std::ranges::lower_bound(row_ns_, point.time_ns - kHalfCycle_ns);
    if (row == row_ns_.end() || *row > point.time_ns + kHalfCycle_ns)
      continue;  // in a gap between cycles, or before the log
    std::vector<double>& column = columns[point.channel];
    if (column.empty()) column.assign(row_ns_.size(), kNone);
    column[static_cast<std::size_t>(row - row_ns_.begin())] =
        point.channel == kForceDepth ? point.value - datum_m : point.value;
  }
  for (std::size_t channel = 0; channel < kChannelCount; ++channel) {
    if (columns[channel].empty()) continue;
    const char* name = channel < kCycleChannels.size() ? kCycleChannels[channel].name
                                                       : kTimedNames[channel - kCycleChannels.size()];
    data.columns.push_back({name, std::move(columns[channel])});
  }
}

void ReportBuilder::add_phases(ReportData& data) const {
  for (std::size_t row = 0; row < row_ns_.size(); ++row) {
    if (row == 0 || state_[row] != state_[row - 1]) {
      data.phases.push_back({seconds(row_ns_[row]), 0.0, std::string(name_of(state_[row]))});
    }
    data.phases.back().to_s = seconds(row_ns_[row]);
  }
  for (std::size_t i = 0; i + 1 < data.phases.size(); ++i) data.phases[i].to_s = data.phases[i + 1].from_s;
}

ReportData ReportBuilder::data() const {
  ReportData data;
  data.time_s.reserve(row_ns_.size());
  for (const std::int64_t time_ns : row_ns_) data.time_s.push_back(seconds(time_ns));
  add_columns(data);
  add_phases(data);
  const ConfigNode* robot = robot_ ? &*robot_ : nullptr;
  for (const Event& event : events_) {
    data.events.push_back({seconds(event.time_ns), event.stride, in_words(name_of(event.kind)),
                           in_words(name_of(event.reason)), values_of(event, robot)});
    if (event.kind == EventKind::fault_raised) {
      const FaultEntry& entry = entry_of(event.fault);
      data.notes.push_back(fmt::format("Fault {} at {:.3f} s: {}. It means: {}. Cure: {}.", entry.name,
                                       seconds(event.time_ns), values_of(event, robot), entry.meaning,
                                       entry.cure));
    }
  }
  for (std::size_t i = 0; i < strides_.size(); ++i) {
    const StrideResult& result = strides_[i];
    const StrideSummary& summary = result.summary;
    data.strides.push_back({.number = summary.stride,
                            .contact_s = seconds(summary.contact_ns),
                            .touchdown_s = seconds(summary.touchdown_ns),
                            .switch_s = seconds(summary.switch_ns),
                            .liftoff_s = seconds(summary.liftoff_ns),
                            .touchdown_speed_mps = summary.touchdown_speed_mps,
                            .peak_force_N = summary.peak_force_N,
                            .max_depth_m = summary.max_depth_m,
                            .crater_depth_m = summary.crater_depth_m,
                            .quasi_static_ols = stiffness(result.quasi_static_ols, summary.crater_depth_m),
                            .observer_ols = stiffness(result.observer_ols, summary.crater_depth_m),
                            .observer_wls = stiffness(result.observer_wls, summary.crater_depth_m),
                            .joint = stiffness(result.joint, summary.crater_depth_m),
                            .profile = profiles_[i],
                            .ground = grounds_[i],
                            .ground_events = ground_events_[i]});
  }
  return data;
}

}  // namespace sandhopper
