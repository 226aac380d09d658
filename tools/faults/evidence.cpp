#include "tools/faults/evidence.hpp"

#include <cmath>

namespace sandhopper::faults {
namespace {

constexpr double kFast_radps = 8.0;  // lowest reading for evidence: with a doubled velocity the error is half
                                     // of it, beyond the tolerance
constexpr int kFast_cycles = 20;     // longer than the check's low-pass and its counter of errors
constexpr int kPure_cycles = 15;     // cycles of pure torque until the check compares it with the current

}  // namespace

int Evidence::needed(const RobotConfig& robot) const {
  if (fault_ == Fault::motor_velocity_implausible) return kFast_cycles;
  if (fault_ == Fault::motor_torque_implausible) return kPure_cycles;
  return fault_ == Fault::motor_reply_lost ? robot.limits.motor_reply_misses : 1;
}

bool Evidence::any_motor(const SensorFrame& frame, auto&& condition) const {
  const auto shows = [&](std::size_t i) { return condition(frame.motor[i]); };
  if (device_ == Device::motor_left) return shows(0);
  if (device_ == Device::motor_right) return shows(1);
  return shows(0) || shows(1);
}

bool Evidence::shows(const SensorFrame& frame, const SensorFrame& before, const StepOutput& output,
                     const RobotConfig& robot) const {
  switch (fault_) {
    case Fault::motor_reply_lost:
      return any_motor(frame, [](const MotorSample& m) { return !m.fresh; });
    case Fault::drive_error:
      return any_motor(frame, [](const MotorSample& m) { return m.fresh && m.error_code != 0; });
    case Fault::bus_voltage_limit:
      return any_motor(frame, [&](const MotorSample& m) {
        return m.fresh && m.bus_voltage_V < robot.supervision.bus_voltage_min_V;
      });
    case Fault::motor_velocity_implausible:
      return any_motor(
          frame, [](const MotorSample& m) { return m.fresh && std::abs(m.velocity_radps) > kFast_radps; });
    case Fault::encoder_stuck: {
      const auto& other = frame.motor[device_ == Device::motor_left ? 1 : 0];
      return std::abs(other.position_rad - other_began_rad_) > robot.supervision.encoder_stuck_rad;
    }
    case Fault::motor_reply_late: {
      const bool previous_ran = frame.cycle == last_cycle_ + 1;
      return previous_ran && any_motor(frame, [&](const MotorSample& m) {
               return m.fresh && to_s(frame.time_ns - m.time_ns) > robot.supervision.motor_reply_age_s;
             });
    }
    case Fault::bus_off:
      return frame.bus.state == BusState::off;
    case Fault::bus_send_refused:
      return frame.bus.send_failures != before.bus.send_failures;
    case Fault::motor_torque_implausible:
      return output.command.drive == DriveRequest::off || output.command.motor[0].kd_Nm_s_per_rad == 0.0;
    case Fault::load_cell_implausible:
    case Fault::estimate_diverged:
    case Fault::energy_implausible:
    case Fault::estimate_not_finite:
      return output.state != State::idle && output.state != State::fault;
    default:
      return true;
  }
}

void Evidence::see(const SensorFrame& frame, const SensorFrame& before, const StepOutput& output,
                   const RobotConfig& robot) {
  if (last_cycle_ == 0) other_began_rad_ = before.motor[device_ == Device::motor_left ? 1 : 0].position_rad;
  in_a_row_ = shows(frame, before, output, robot) ? in_a_row_ + 1 : 0;
  complete_ = complete_ || in_a_row_ >= needed(robot);
  last_cycle_ = frame.cycle;
}

std::string Evidence::wanted() const {
  switch (fault_) {
    case Fault::motor_reply_lost:
      return "replies do not fail often enough in a row";
    case Fault::drive_error:
      return "no reply with an error code arrives";
    case Fault::bus_voltage_limit:
      return "no reply with the supply's voltage arrives";
    case Fault::motor_velocity_implausible:
      return "the leg does not turn fast enough for long enough";
    case Fault::motor_reply_late:
      return "while every second cycle is missing, a late reply comes in time";
    case Fault::bus_off:
      return "the controller does not report it";
    case Fault::bus_send_refused:
      return "no frame is refused";
    case Fault::motor_torque_implausible:
      return "the drives' own law runs, whose torque is not known";
    case Fault::load_cell_implausible:
    case Fault::estimate_diverged:
    case Fault::energy_implausible:
    case Fault::estimate_not_finite:
      return "in state fault nothing is estimated, and the drives' own damping needs no sensor";
    default:
      return "the leg does not move enough";
  }
}

}  // namespace sandhopper::faults
