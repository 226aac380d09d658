#include "tools/terrain/hop_frames.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "firmware/cycle.hpp"

namespace sandhopper {
namespace {

constexpr std::array<std::string_view, 2> kSides{"left", "right"};
constexpr double kFreeFall_mps2 = 5.0;  // a smaller specific force of the body means that it was released
constexpr int kFreeFallRows = 3;
constexpr double kShortestRest_s = 0.02;

std::int64_t nanoseconds(double seconds) { return static_cast<std::int64_t>(std::llround(seconds * 1e9)); }

using Column = std::vector<double>;

// Newest value up to each row; zero before the first one.
Column held(const Column& column) {
  Column out(column.size(), 0.0);
  double last = 0.0;
  for (std::size_t row = 0; row < column.size(); ++row) {
    if (!std::isnan(column[row])) last = column[row];
    out[row] = last;
  }
  return out;
}

// Backward difference of the fresh samples; replaces the speed if the drive does not report it.
Column differenced(const std::vector<double>& t_s, const Column& position) {
  Column speed(position.size(), NAN);
  std::size_t before = position.size();
  for (std::size_t row = 0; row < position.size(); ++row) {
    if (std::isnan(position[row])) continue;
    speed[row] = before < row ? (position[row] - position[before]) / (t_s[row] - t_s[before]) : 0.0;
    before = row;
  }
  return speed;
}

class FrameMaker {
 public:
  FrameMaker(const CampaignTrial& trial, const TrialRecording& recording, const Leg& leg)
      : trial_(trial), belief_(std::get<HopperBelief>(trial.belief)), in_(recording), leg_(leg) {}

  std::optional<HopFrames> run(std::string& missing) {
    if (missing = what_is_missing(); !missing.empty()) return std::nullopt;
    out_.frames.resize(in_.rows());
    for (std::size_t row = 0; row < in_.rows(); ++row) {
      out_.frames[row].time_ns = nanoseconds(in_.t_s[row]);
      out_.frames[row].cycle = row;
    }
    for (std::size_t side = 0; side < kMotorCount; ++side) add_motor(side);
    add_imu("imu_body_accel_z_mps2", &SensorFrame::imu_body);
    add_imu("imu_foot_accel_z_mps2", &SensorFrame::imu_foot);
    add_height();
    add_load_cell();
    if (const auto* phase = in_.find("phase")) out_.phase = *phase;
    find_release();
    calibrate();
    return std::move(out_);
  }

 private:
  std::string what_is_missing() const {
    std::string missing;
    const auto need = [&](bool there, std::string_view name) {
      if (!there) missing += fmt::format("{}{}", missing.empty() ? "" : ", ", name);
    };
    need(in_.has("motor_left_position_rad") || in_.has("motor_right_position_rad"), "motor_…_position_rad");
    need(in_.has("motor_left_current_A") || in_.has("motor_right_current_A") ||
             in_.has("command_left_torque_Nm") || in_.has("command_right_torque_Nm"),
         "motor_…_current_A");
    need(in_.has("imu_body_accel_z_mps2"), "imu_body_accel_z_mps2");
    need(in_.has("imu_foot_accel_z_mps2"), "imu_foot_accel_z_mps2");
    return missing;
  }

  // Channel of this side, or of the other side if this one was not recorded.
  const Column* of_side(std::size_t side, std::string_view pattern) const {
    const auto name = [&](std::size_t which) { return fmt::format(fmt::runtime(pattern), kSides[which]); };
    const auto* own = in_.find(name(side));
    return own != nullptr ? own : in_.find(name(1 - side));
  }

  void note_once(const std::string& text) {
    if (std::find(out_.notes.begin(), out_.notes.end(), text) == out_.notes.end()) out_.notes.push_back(text);
  }

  void add_motor(std::size_t side) {
    if (!in_.has(fmt::format("motor_{}_position_rad", kSides[side])))
      note_once(fmt::format("the {} motor was not recorded; the other one stands for both", kSides[side]));
    const Column& position = *of_side(side, "motor_{}_position_rad");
    const auto* speed = of_side(side, "motor_{}_velocity_radps");
    if (speed == nullptr) note_once("motor speeds were not recorded; differences of the positions stand in");
    const Column speeds = held(speed != nullptr ? *speed : differenced(in_.t_s, position));
    const Column currents = held(current_of(side));
    const Column positions = held(position);
    // In the firmware's own log a cycle contains the reply to the previous cycle's command.
    const std::int64_t age_ns =
        in_.own_log ? kCyclePeriod_ns : nanoseconds(belief_.sensors.other.encoder_latency_s);
    for (std::size_t row = 0; row < in_.rows(); ++row) {
      auto& motor = out_.frames[row].motor[side];
      motor.fresh = !std::isnan(position[row]);
      motor.time_ns = motor.fresh || row == 0 ? out_.frames[row].time_ns - age_ns
                                              : out_.frames[row - 1].motor[side].time_ns;
      motor.position_rad = positions[row];
      motor.velocity_radps = speeds[row];
      motor.current_A = currents[row];
    }
  }

  Column current_of(std::size_t side) {
    if (const auto* current = of_side(side, "motor_{}_current_A")) return *current;
    note_once("motor currents were not recorded; the commanded torques stand in");
    Column current = *of_side(side, "command_{}_torque_Nm");
    for (double& value : current) value /= belief_.motor.torque_constant_Nm_per_A;
    return current;
  }

  void add_imu(std::string_view name, ImuSample SensorFrame::*imu) {
    const Column& fresh = *in_.find(name);
    const Column values = held(fresh);
    for (std::size_t row = 0; row < in_.rows(); ++row) {
      auto& sample = out_.frames[row].*imu;
      sample.fresh = !std::isnan(fresh[row]);
      sample.time_ns = out_.frames[row].time_ns;
      sample.accel_mps2[2] = values[row];
    }
  }

  void add_height() {
    const auto* height = in_.find("tof_height_m");
    if (height == nullptr) {
      note_once("no height sensor: depth counts from the first contact");
      return;
    }
    const std::int64_t age_ns = nanoseconds(belief_.sensors.robot.tof_latency_s);
    for (std::size_t row = 0; row < in_.rows(); ++row) {
      auto& tof = out_.frames[row].tof;
      tof.fresh = !std::isnan((*height)[row]);
      tof.height_m = (*height)[row];
      tof.time_ns = out_.frames[row].time_ns - age_ns;
    }
  }

  void add_load_cell() {
    const auto* force = in_.find("load_cell_force_N");
    if (force == nullptr) return;
    for (std::size_t row = 0; row < in_.rows(); ++row) {
      auto& cell = out_.frames[row].load_cell;
      cell.fresh = !std::isnan((*force)[row]) && !in_.is_saturated("load_cell_force_N", row);
      cell.time_ns = out_.frames[row].time_ns;
      cell.force_N = (*force)[row];
    }
  }

  // The recorded phase gives the release if it also covers the time before the hop. Otherwise the body's
  // accelerometer does.
  void find_release() {
    if (!out_.phase.empty() && std::isnan(out_.phase.front())) {
      while (out_.release_row < out_.phase.size() && std::isnan(out_.phase[out_.release_row]))
        ++out_.release_row;
      if (out_.release_row < out_.phase.size()) return;
    }
    out_.release_row = 0;
    int falling = 0;
    for (std::size_t row = 0; row < out_.frames.size(); ++row) {
      falling = out_.frames[row].imu_body.accel_mps2[2] < kFreeFall_mps2 ? falling + 1 : 0;
      if (falling < kFreeFallRows) continue;
      out_.release_row = row + 1 - static_cast<std::size_t>(kFreeFallRows);
      return;
    }
  }

  void calibrate() {
    struct Mean {
      double sum = 0.0;
      int count = 0;
      void add(bool there, double value) {
        if (!there) return;
        sum += value;
        ++count;
      }
      double value() const { return count > 0 ? sum / count : 0.0; }
    } body, foot, height;
    const double release_s = in_.t_s[out_.release_row];
    out_.rest_seen = release_s - in_.t_s.front() >= kShortestRest_s;
    const std::size_t last = out_.rest_seen ? out_.release_row : std::min<std::size_t>(10, in_.rows());
    for (std::size_t row = 0; row < last; ++row) {
      const auto& frame = out_.frames[row];
      if (release_s - in_.t_s[row] > 1.0) continue;
      body.add(frame.imu_body.fresh, frame.imu_body.accel_mps2[2]);
      foot.add(frame.imu_foot.fresh, frame.imu_foot.accel_mps2[2]);
      height.add(frame.tof.fresh, frame.tof.height_m);
    }
    if (out_.rest_seen) {
      out_.calibration.body_bias_mps2 = body.value() - kGravity_mps2;
      out_.calibration.foot_bias_mps2 = foot.value() - kGravity_mps2;
    } else {
      note_once("the recording begins after the release: IMU offsets are taken as zero");
    }
    out_.speed_known = out_.rest_seen || trial_.number("release_height_m").has_value();
    out_.calibration.body_height_m = height.count > 0 ? height.value() : expected_height_m();
  }

  // Height of the hip axis according to the release height in the set-up.
  double expected_height_m() const {
    const auto leg = leg_measurement(out_.frames[out_.release_row], measuring_);
    return trial_.number("release_height_m").value_or(0.0) + belief_.robot.leg.foot_height_m +
           leg_.kinematics(leg.angle_rad).length_m;
  }

  const CampaignTrial& trial_;
  const HopperBelief& belief_;
  const TrialRecording& in_;
  const Leg& leg_;
  CycleConfig measuring_{};
  HopFrames out_;
};

}  // namespace

std::optional<HopFrames> hop_frames(const CampaignTrial& trial, const TrialRecording& recording,
                                    const Leg& leg, std::string& missing) {
  return FrameMaker(trial, recording, leg).run(missing);
}

}  // namespace sandhopper
