#include <cmath>

#include "estimation/kalman_filter.hpp"
#include "tools/faults/cell.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::array kPhases{Phase::idle, Phase::armed, Phase::flight, Phase::compression, Phase::extension};
constexpr std::array kMotors{Device::motor_left, Device::motor_right};
constexpr const char* kAtRest = "nothing moves: a sound one would read the same";

bool at_rest(Phase phase) { return phase == Phase::idle || phase == Phase::armed; }

// True if the leg has moved by more than 0.02 rad since the injection. For faults that cannot be detected at
// rest.
bool moved(const SensorFrame& frame, const Injected& injected) {
  for (std::size_t i = 0; i < kMotorCount; ++i)
    if (std::abs(frame.motor[i].position_rad - injected.frame.motor[i].position_rad) > 0.02) return true;
  return false;
}

class Cells {
 public:
  std::vector<Cell> take() { return std::move(cells_); }

  Cell& add(Device device, Kind kind, Phase phase, Fault expected) {
    cells_.push_back({.device = device, .kind = kind, .phase = phase, .expected = expected});
    return cells_.back();
  }
  void in_every_phase(Device device, Kind kind, Fault expected) {
    for (const auto phase : kPhases) add(device, kind, phase, expected);
  }
  // For a fault that only motion shows.
  void in_motion(Device device, Kind kind, Fault expected) {
    for (const auto phase : kPhases) {
      auto& cell = add(device, kind, phase, at_rest(phase) ? Fault::none : expected);
      if (at_rest(phase))
        cell.note = kAtRest;
      else
        cell.visible = [](const SensorFrame& f, const StepOutput&, const Injected& i) { return moved(f, i); };
    }
  }

 private:
  std::vector<Cell> cells_;
};

void add_motors(Cells& cells) {
  for (const auto motor : kMotors) {
    cells.in_every_phase(motor, Kind::off, Fault::motor_reply_lost);
    cells.in_motion(motor, Kind::stuck, Fault::encoder_stuck);
    cells.in_every_phase(motor, Kind::garbage, Fault::motor_position_jump);
    cells.in_motion(motor, Kind::wrong, Fault::motor_velocity_implausible);
    cells.in_every_phase(motor, Kind::slow, Fault::motor_reply_lost);
    cells.in_every_phase(motor, Kind::delayed, Fault::motor_reply_late);
    cells.in_every_phase(motor, Kind::intermittent, Fault::motor_reply_intermittent);
    cells.in_every_phase(motor, Kind::saturated, Fault::motor_speed_limit);
    for (const auto phase : kPhases)
      cells.add(motor, Kind::drifting, phase,
                phase == Phase::idle ? Fault::motor_velocity_implausible : Fault::encoders_disagree);
    cells.in_every_phase(motor, Kind::error, Fault::drive_error);
    cells.in_every_phase(motor, Kind::announced_loss, Fault::drive_error);
    cells.in_every_phase(motor, Kind::hot, Fault::motor_temperature);
    cells.in_every_phase(motor, Kind::current, Fault::motor_torque_implausible);
    cells.in_every_phase(motor, Kind::overcurrent, Fault::motor_current_limit);
    for (const auto phase : kPhases)
      cells.add(motor, Kind::undervoltage, phase, Fault::bus_voltage_limit).change = [](RobotConfig& robot) {
        for (auto& m : robot.motor) m.reply = ReplyFlavour::bus_voltage;
      };
  }
}

void add_imus(Cells& cells) {
  for (const auto imu : {Device::imu_body, Device::imu_foot}) {
    cells.in_every_phase(imu, Kind::off, Fault::imu_stale);
    cells.in_every_phase(imu, Kind::stuck, Fault::imu_stuck);
    cells.in_every_phase(imu, Kind::garbage, Fault::imu_implausible);
    cells.in_every_phase(imu, Kind::wrong, Fault::imu_implausible);
    cells.in_every_phase(imu, Kind::slow, Fault::imu_stale);
    cells.in_every_phase(imu, Kind::delayed, Fault::imu_stale);
    cells.in_every_phase(imu, Kind::intermittent, Fault::sensor_intermittent);
    cells.in_every_phase(imu, Kind::saturated, Fault::imu_out_of_range);
    for (const auto phase : kPhases)
      cells.add(imu, Kind::not_a_number, phase,
                phase == Phase::idle ? Fault::imu_out_of_range : Fault::estimate_not_finite);
    cells.in_every_phase(imu, Kind::future, Fault::sample_time_invalid);
    cells.in_every_phase(imu, Kind::backward, Fault::sample_time_invalid);
  }
}

void add_slow_sensors(Cells& cells) {
  cells.in_every_phase(Device::tof, Kind::off, Fault::tof_stale);
  cells.in_every_phase(Device::tof, Kind::stuck, Fault::tof_stuck);
  cells.in_every_phase(Device::tof, Kind::garbage, Fault::tof_implausible);
  cells.in_every_phase(Device::tof, Kind::wrong, Fault::tof_implausible);
  cells.in_every_phase(Device::tof, Kind::slow, Fault::tof_stale);
  cells.in_every_phase(Device::tof, Kind::delayed, Fault::tof_stale);
  cells.in_every_phase(Device::tof, Kind::intermittent, Fault::sensor_intermittent);
  cells.in_every_phase(Device::tof, Kind::saturated, Fault::tof_out_of_range);

  const auto cell = Device::load_cell;
  cells.in_every_phase(cell, Kind::off, Fault::load_cell_stale);
  cells.in_every_phase(cell, Kind::stuck, Fault::load_cell_stuck);
  // Random forces: chance decides if one beyond the range or one that contradicts the leg is found first.
  for (const auto phase : kPhases)
    cells.add(cell, Kind::garbage, phase, Fault::load_cell_out_of_range).or_else =
        Fault::load_cell_implausible;
  for (const auto phase : kPhases) {
    auto& wrong = cells.add(cell, Kind::wrong, phase,
                            phase == Phase::idle ? Fault::none : Fault::load_cell_implausible);
    if (phase == Phase::idle)
      wrong.note = "its tare is taken when the robot is armed: an offset before is the tare";
  }
  cells.in_every_phase(cell, Kind::slow, Fault::load_cell_stale);
  cells.in_every_phase(cell, Kind::delayed, Fault::load_cell_stale);
  cells.in_every_phase(cell, Kind::intermittent, Fault::sensor_intermittent);
  cells.in_every_phase(cell, Kind::saturated, Fault::load_cell_out_of_range);
}

void add_bus(Cells& cells) {
  const auto bus = Device::bus;
  cells.in_every_phase(bus, Kind::cable_off, Fault::bus_passive);
  cells.in_every_phase(bus, Kind::blocked, Fault::bus_send_refused);
  cells.in_every_phase(bus, Kind::refused, Fault::bus_send_refused);
  cells.in_every_phase(bus, Kind::bus_off, Fault::bus_off);
  cells.in_every_phase(bus, Kind::passive, Fault::bus_passive);
  cells.in_every_phase(bus, Kind::no_acknowledge, Fault::bus_passive);
  cells.in_every_phase(bus, Kind::lost, Fault::motor_reply_lost);
  cells.in_every_phase(bus, Kind::late, Fault::motor_reply_late);
  cells.in_every_phase(bus, Kind::duplicated, Fault::motor_reply_unexpected);
  cells.in_every_phase(bus, Kind::foreign, Fault::motor_reply_foreign);
  cells.in_every_phase(bus, Kind::malformed, Fault::motor_reply_foreign);
  cells.in_every_phase(bus, Kind::overflow, Fault::bus_overflow);
  cells.in_every_phase(bus, Kind::protocol_error, Fault::bus_fault);
  cells.in_every_phase(bus, Kind::miscoded, Fault::transmit_refused);
}

void add_system(Cells& cells) {
  for (const auto kind : {Kind::pressed, Kind::tapped, Kind::wire_cut})
    cells.in_every_phase(Device::estop, kind, Fault::emergency_stop);
  cells.in_every_phase(Device::computer, Kind::stalled, Fault::cycle_gap);
  for (const auto phase : kPhases)
    cells.add(Device::computer, Kind::overruns, phase, Fault::cycle_overruns).visible =
        [](const SensorFrame& f, const StepOutput&, const Injected&) { return f.overruns > 50; };
  cells.in_every_phase(Device::computer, Kind::watchdog, Fault::watchdog_tripped);
  cells.in_every_phase(Device::robot, Kind::tilting, Fault::tilt_limit);
  cells.add(Device::robot, Kind::lifted, Phase::flight, Fault::energy_implausible);
  // Visible from the first ToF height on that the filter's gate rejects.
  for (const auto phase : {Phase::armed, Phase::flight, Phase::compression, Phase::extension})
    cells.add(Device::robot, Kind::biased, phase, Fault::estimate_diverged).visible =
        [](const SensorFrame&, const StepOutput& o, const Injected&) {
          static const double gate = KalmanConfig{}.tof_gate_sigma;
          return o.estimate.normalised_innovation_squared[0] > gate * gate;
        };
}

// A sound robot with one limit set so close that the trial must exceed it. Visible from the first cycle
// beyond it.
void add_limits(Cells& cells) {
  using Visible = decltype(Cell::visible);
  using Change = decltype(Cell::change);
  const auto limit = [&](Phase phase, Fault fault, Change change, Visible visible) {
    auto& cell = cells.add(Device::robot, Kind::limit, phase, fault);
    cell.change = std::move(change);
    cell.visible = std::move(visible);
  };
  limit(
      Phase::compression, Fault::leg_angle_limit, [](RobotConfig& r) { r.limits.leg_angle_max_rad = 1.30; },
      [](const SensorFrame& f, const StepOutput&, const Injected&) {
        return f.motor[0].position_rad > 1.30 || f.motor[1].position_rad > 1.30;
      });
  limit(
      Phase::compression, Fault::leg_length_limit,
      [](RobotConfig& r) { r.supervision.leg_length_min_m = 0.28; },
      [](const SensorFrame&, const StepOutput& o, const Injected&) {
        return o.estimate.leg_length_m > 0.1 && o.estimate.leg_length_m < 0.28;
      });
  limit(
      Phase::flight, Fault::body_speed_limit, [](RobotConfig& r) { r.supervision.body_speed_mps = 0.6; },
      [](const SensorFrame&, const StepOutput& o, const Injected&) {
        return o.estimate.body_velocity_mps < -0.6;
      });
  limit(
      Phase::armed, Fault::body_height_limit, [](RobotConfig& r) { r.supervision.foot_height_m = 0.03; },
      [](const SensorFrame&, const StepOutput& o, const Injected&) { return o.estimate.foot_z_m > 0.03; });
  limit(
      Phase::flight, Fault::phase_timeout,
      [](RobotConfig& r) {
        r.limits.phase_time_s = 0.1;
        r.controller.touchdown_deflection_m = 0.1;
        r.controller.touchdown_rate_mps = 5.0;
      },
      [since = std::int64_t{0}](const SensorFrame& f, const StepOutput& o, const Injected&) mutable {
        if (since == 0 && o.state == State::flight) since = f.time_ns;
        return since != 0 && f.time_ns - since > 100'000'000;
      });
  limit(
      Phase::compression, Fault::motor_torque_limit,
      [](RobotConfig& r) {
        r.limits.motor_torque_Nm = 0.5;
        r.supervision.torque_limit_s = 0.05;
      },
      [](const SensorFrame&, const StepOutput& o, const Injected&) {
        return std::abs(o.command.motor[0].torque_Nm) > 0.499;
      });
  limit(
      Phase::compression, Fault::motor_winding_hot,
      [](RobotConfig& r) { r.supervision.winding_temperature_C = 25.02; },
      // Winding heat without the flow to the housing: sum of 1.5 R i^2 dt against C times 0.02 K, with R =
      // 0.0625 ohm, dt = 1 ms, C = 40 J/K.
      [heat_J = std::array<double, kMotorCount>{}](const SensorFrame& f, const StepOutput&,
                                                   const Injected&) mutable {
        bool hot = false;
        for (std::size_t i = 0; i < kMotorCount; ++i) {
          heat_J[i] += 1.5 * 0.0625 * f.motor[i].current_A * f.motor[i].current_A * 1e-3;
          hot = hot || heat_J[i] > 40.0 * 0.02;
        }
        return hot;
      });
  limit(
      Phase::flight, Fault::hop_count_limit, [](RobotConfig& r) { r.supervision.hop_count = 1; },
      [](const SensorFrame&, const StepOutput& o, const Injected&) { return o.stride > 1; });
}

}  // namespace

std::string Cell::name() const {
  std::string text = std::string(name_of(device)) + " " + std::string(name_of(kind));
  if (kind == Kind::limit) text = std::string(name_of(expected)) + " drawn close";
  return text;
}

std::vector<Cell> all_cells() {
  Cells cells;
  add_motors(cells);
  add_imus(cells);
  add_slow_sensors(cells);
  add_bus(cells);
  add_system(cells);
  add_limits(cells);
  return cells.take();
}

}  // namespace sandhopper::faults
