#include "tools/diagnose/plants/hopper/hopper_recording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper::diagnose {
namespace {

constexpr double kFreeFall_mps2 = 5.0;  // after the release the body's accelerometer reads less than this
constexpr double kBegins_s = 0.005;     // a held leg that was just released falls this long
constexpr double kAboutAtSurface_m = 0.008;  // a foot nearer to the surface stands on it

double release_time_s(const Trial& trial) {
  const auto body = samples_of(trial, "imu_body_accel_z_mps2");
  for (std::size_t i = 2; i < body.value.size(); ++i)
    if (body.value[i] < kFreeFall_mps2 && body.value[i - 1] < kFreeFall_mps2 &&
        body.value[i - 2] < kFreeFall_mps2)
      return body.time_s[i - 2] < 0.01 ? trial.time_s.front() : body.time_s[i - 2] - 1e-3;
  return trial.time_s.empty() ? 0.0 : trial.time_s.front();
}

// Value and rate at `time_s` from a parabola through the samples within `half_s`.
struct AtTime {
  double value = 0.0, rate = 0.0;
  bool known = false;
};
AtTime local_fit(const Samples& samples, double time_s, double half_s) {
  Samples near;
  for (std::size_t i = 0; i < samples.value.size(); ++i)
    if (std::abs(samples.time_s[i] - time_s) <= half_s) {
      near.time_s.push_back(samples.time_s[i]);
      near.value.push_back(samples.value[i]);
    }
  if (near.value.size() < 4) return {};
  const auto middle = static_cast<std::size_t>(
      std::lower_bound(near.time_s.begin(), near.time_s.end(), time_s) - near.time_s.begin());
  const auto at = std::min(middle, near.value.size() - 1);
  const Smoothed fit = smooth(near, near.value.size());
  return {fit.value[at] + fit.rate[at] * (time_s - near.time_s[at]), fit.rate[at], true};
}

struct BodyHeight {
  Samples samples;
  double half_s = 0.02;  // half-width of a local fit
};
BodyHeight body_height(const Trial& trial) {
  BodyHeight height{samples_of(trial, "mocap_body_z_m"), 0.02};
  if (height.samples.value.size() < 10) height = {samples_of(trial, "tof_height_m"), 0.03};
  return height;
}

double angle_at_length(const Leg& leg, double length_m) {
  double low = 0.0, high = 3.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (leg.kinematics(middle).length_m > length_m ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

HopStart start_from_data(const Trial& trial, const Leg& leg, double time_s) {
  HopStart start;
  start.from_s = time_s;
  const auto angle = local_fit(mean_of_motors(trial, "position_rad"), time_s, 0.008);
  const auto height = body_height(trial);
  const auto body = local_fit(height.samples, time_s, height.half_s);
  start.state.angle_rad = angle.value;
  start.state.angular_velocity_radps = angle.rate;
  const auto kinematics = leg.kinematics(angle.value);
  const double toe_to_hip_m = kinematics.length_m + leg.parameters().foot_height_m;
  start.state.foot_z_m = body.known ? body.value - toe_to_hip_m : 0.0;
  start.state.foot_velocity_mps = body.known ? body.rate - kinematics.dlength_m_per_rad * angle.rate : 0.0;
  return start;
}

// Leg angle at the release: the encoder's reading if it differs from the believed angle by more than 1 mrad.
double angle_held(const Trial& trial, double time_s, double believed_rad) {
  constexpr double kApart_rad = 1e-3;
  const auto read = local_fit(mean_of_motors(trial, "position_rad"), time_s, 0.008);
  return read.known && std::abs(read.value - believed_rad) > kApart_rad ? read.value : believed_rad;
}

// A leg of a hold trial that falls freely in the first rows was released there, before the ground carried it.
// It is at rest, and a foot close to the surface is on it. Heights alone show this only to within millimetres
// and decimetres per second.
void let_go_where_it_begins(const Trial& trial, HopStart& start) {
  if (trial.kind != "hold") return;
  const auto body = samples_of(trial, "imu_body_accel_z_mps2");
  std::size_t falling = 0;
  while (falling < body.value.size() && body.time_s[falling] < start.from_s + kBegins_s &&
         body.value[falling] < kFreeFall_mps2)
    ++falling;
  const bool all =
      falling > 0 && (falling == body.value.size() || body.time_s[falling] >= start.from_s + kBegins_s);
  if (!all || std::abs(start.state.foot_z_m) > kAboutAtSurface_m) return;
  start.state.foot_z_m = start.state.foot_velocity_mps = start.state.angular_velocity_radps = 0.0;
}

}  // namespace

std::vector<PhaseChange> phase_changes(const Trial& trial) {
  constexpr double kHalfARow = 0.5;
  std::vector<PhaseChange> phases;
  const auto recorded = samples_of(trial, "phase");
  const double row_s = median_step_s(recorded.time_s);
  for (std::size_t i = 0; i < recorded.value.size(); ++i) {
    const auto phase = static_cast<HopperPhase>(std::clamp(std::lround(recorded.value[i]), 0L, 2L));
    if (!phases.empty() && phases.back().phase == phase) continue;
    phases.push_back({recorded.time_s[i], phase});
    // With rows missing before it, the change may belong to any of them: take their middle.
    const double missing_s = i == 0 ? 0.0 : recorded.time_s[i] - recorded.time_s[i - 1] - row_s;
    if (missing_s < kHalfARow * row_s) continue;
    phases.back().unsure_s = 0.5 * missing_s;
    phases.back().time_s -= phases.back().unsure_s;
  }
  return phases;
}

Samples mean_of_motors(const Trial& trial, const std::string& quantity) {
  const auto left = samples_of(trial, "motor_left_" + quantity);
  const auto right = samples_of(trial, "motor_right_" + quantity);
  if (left.empty()) return right;
  if (left.value.size() != right.value.size()) return left;
  Samples mean = left;
  for (std::size_t i = 0; i < mean.value.size(); ++i) mean.value[i] = 0.5 * (left.value[i] + right.value[i]);
  return mean;
}

bool currents_follow_own_row(const Trial& trial) {
  constexpr double kNearer = 0.5;  // largest ratio of the variances that the two commands leave
  const auto* current = trial.find("motor_left_current_A");
  const auto* command = trial.find("command_left_torque_Nm");
  if (current == nullptr || command == nullptr) return false;
  // Variance of the current that a line through the command of `late` rows before leaves.
  const auto left_by = [&](std::size_t late) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t k = 1; k < current->size(); ++k) {
      const double own = (*command)[k - late], value = (*current)[k];
      if (std::isnan((*command)[k]) || std::isnan((*command)[k - 1]) || std::isnan(value)) continue;
      n += 1.0, x += own, y += value, xx += own * own, xy += own * value, yy += value * value;
    }
    const double var_x = xx - x * x / n, cov = xy - x * y / n;
    return var_x > 0.0 ? yy - y * y / n - cov * cov / var_x : std::numeric_limits<double>::infinity();
  };
  return left_by(0) < kNearer * left_by(1);
}

Trial with_commands_a_row_earlier(Trial trial) {
  for (auto& [name, values] : trial.channels)
    if ((name == "phase" || name.starts_with("command_")) && values.size() > 1)
      std::rotate(values.begin(), values.begin() + 1, values.end()),
          values.back() = values[values.size() - 2];
  return trial;
}

Samples commands_of(const Trial& trial) {
  auto sum = samples_of(trial, "command_left_torque_Nm");
  const auto right = samples_of(trial, "command_right_torque_Nm");
  for (std::size_t i = 0; i < sum.value.size(); ++i)
    sum.value[i] += right.value.size() == sum.value.size() ? right.value[i] : sum.value[i];
  return sum;
}

MeasuredLeg measured_leg(const Trial& trial) {
  MeasuredLeg leg;
  const auto mean = [&](const std::string& quantity, std::size_t i) {
    const auto* left = trial.find("motor_left_" + quantity);
    const auto* right = trial.find("motor_right_" + quantity);
    if (left == nullptr) return right == nullptr ? std::nan("") : (*right)[i];
    return right == nullptr ? (*left)[i] : 0.5 * ((*left)[i] + (*right)[i]);
  };
  for (std::size_t i = 0; i < trial.time_s.size(); ++i) {
    const double angle = mean("position_rad", i), rate = mean("velocity_radps", i);
    if (!std::isfinite(angle) || !std::isfinite(rate)) continue;
    leg.time_s.push_back(trial.time_s[i]);
    leg.angle_rad.push_back(angle);
    leg.rate_radps.push_back(rate);
  }
  return leg;
}

std::vector<PhaseChange> at_cycles(const HopperCourse& course, double cycle_s) {
  auto phases = course.phases;
  for (auto& change : phases) {
    double from_s = course.hops.empty() ? 0.0 : course.hops.front().from_s;
    for (const auto& hop : course.hops)
      if (hop.from_s <= change.time_s) from_s = hop.from_s;
    change.time_s = from_s + std::round((change.time_s - from_s) / cycle_s) * cycle_s;
  }
  return phases;
}

HopperCourse course_of(const Trial& trial, const Leg& leg, double flight_length_m) {
  HopperCourse course;
  if (trial.time_s.empty()) return course;
  course.phases = phase_changes(trial);
  course.end_s = trial.time_s.back();
  const bool released = trial.setup.contains("release_height_m") &&
                        (course.phases.empty() || course.phases.front().phase == HopperPhase::flight);
  if (released) {
    HopStart start;
    start.from_s = release_time_s(trial);
    start.state.foot_z_m = trial.setup_or("release_height_m", 0.05);
    start.state.angle_rad = angle_held(trial, start.from_s, angle_at_length(leg, flight_length_m));
    start.at_rest = true;
    course.hops.push_back(start);
  } else {
    course.hops.push_back(start_from_data(trial, leg, trial.time_s.front()));
    let_go_where_it_begins(trial, course.hops.back());
  }
  // The course ends before the second landing: the foot meets the crater's unloading line there, and the
  // impact depends on tenths of a millimetre.
  for (std::size_t i = 1; i + 1 < course.phases.size(); ++i)
    if (course.phases[i].phase == HopperPhase::flight) {
      course.end_s = 0.5 * (course.phases[i].time_s + course.phases[i + 1].time_s);
      break;
    }
  return course;
}

}  // namespace sandhopper::diagnose
