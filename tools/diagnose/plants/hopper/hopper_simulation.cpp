#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/ground_laws.hpp"
#include "tools/plant/nominal_controller.hpp"

namespace sandhopper::diagnose {
namespace {

class PortLaws final : public PlantExtension {
 public:
  explicit PortLaws(const Edits& edits) : rail_(edits.at(LawPort::rail)), joint_(edits.at(LawPort::joint)) {}
  bool empty() const { return rail_.empty() && joint_.empty(); }
  void at_time(double time_s) { time_s_ = time_s; }

  double rail_force_N(double z, double v, double leg_force_N) const override {
    return rail_.empty()
               ? 0.0
               : sum_of(rail_,
                        RailState{
                            .time_s = time_s_, .height_m = z, .velocity_mps = v, .leg_force_N = leg_force_N});
  }
  double joint_torque_Nm(const PlantState& s, double motor_torque_Nm) const override {
    if (joint_.empty()) return 0.0;
    return sum_of(joint_, AxisState{.time_s = time_s_,
                                    .angle_rad = s.angle_rad,
                                    .velocity_radps = s.angular_velocity_radps,
                                    .torque_Nm = motor_torque_Nm});
  }

 private:
  std::vector<const Law*> rail_, joint_;
  double time_s_ = 0.0;
};

// Drive: from the commanded torque to the current, and from the current to the torque on the links.
class Actuator {
 public:
  Actuator(const Edits& edits, const HopperRun& run)
      : step_s_(run.step_s),
        factor_(run.torque_constant_factor),
        temperature_C_(run.motor_temperature_C),
        limits_(edits.at(LawPort::actuator_limit)) {
    const double time_constant_s = run.world.motor.current_loop_time_constant_s;
    for (const auto& edit : edits.sensors) {
      if (edit.channel != "actuator") continue;
      switch (edit.kind) {
        case SensorEdit::Kind::gain:
          factor_ += edit.value - 1.0;  // adds up with the trial's own share, as the laws below do
          break;
        case SensorEdit::Kind::offset:
          offset_Nm_ += edit.value;
          break;
        case SensorEdit::Kind::delay_s:
          delay_s_ += edit.value;
          break;
        case SensorEdit::Kind::lag_s:
          lag_decay_ = decay(edit.value);
          break;
        case SensorEdit::Kind::law:
          laws_.push_back(&edit.law);
          break;
        default:
          break;
      }
    }
    loop_decay_ = decay(time_constant_s);
    // A current loop that acts at the start of 0.1 ms steps is half a step ahead of a continuous one.
    // Recordings may come from either, so this takes the middle. A tolerance covers the difference
    // (drive_unsure_s).
    const double ahead = time_constant_s > 0.0 ? std::exp(-0.25 * Plant::kStep_s / time_constant_s) : 0.0;
    loop_mean_ = ahead * (1.0 - loop_decay_) * time_constant_s / step_s_;
    history_.fill(0.0);
  }

  // One grid step with the command held. Returns the mean current over the step, as torque with the nominal
  // constant.
  double step(double command_Nm, double rate_radps) {
    if (!limits_.empty()) {
      const double limit_Nm =
          std::max(0.0, sum_of(limits_, DriveState{.rate_radps = rate_radps, .command_Nm = command_Nm}));
      command_Nm = std::clamp(command_Nm, -limit_Nm, limit_Nm);
    }
    newest_ = (newest_ + 1) % history_.size();
    history_[newest_] = command_Nm;
    // A negative delay becomes an overshoot of the next step with the same impulse.
    const double steps = std::clamp(delay_s_ / step_s_, -1.0, static_cast<double>(history_.size() - 2));
    const auto whole = static_cast<std::size_t>(std::max(0.0, steps));
    const double part = steps - static_cast<double>(whole);
    const auto back = [&](std::size_t n) {
      return history_[(newest_ + history_.size() - n) % history_.size()];
    };
    const double delayed = (1.0 - part) * back(whole) + part * back(whole + 1);
    lagged_ = delayed + (lagged_ - delayed) * lag_decay_;
    const double mean_Nm = lagged_ + (current_Nm_ - lagged_) * loop_mean_;
    current_Nm_ = lagged_ + (current_Nm_ - lagged_) * loop_decay_;
    return mean_Nm;
  }

  double current_Nm() const { return current_Nm_; }

  double torque_Nm(double current_Nm, double time_s) const {
    double torque = factor_ * current_Nm + offset_Nm_;
    if (!laws_.empty())
      torque +=
          sum_of(laws_, SensorState{.time_s = time_s, .value = current_Nm, .temperature_C = temperature_C_});
    return torque;
  }

 private:
  double decay(double time_constant_s) const {
    return time_constant_s > 0.0 ? std::exp(-step_s_ / time_constant_s) : 0.0;
  }

  double step_s_, factor_, offset_Nm_ = 0.0, delay_s_ = 0.0, lag_decay_ = 0.0, loop_decay_ = 0.0,
                           loop_mean_ = 0.0;
  double lagged_ = 0.0, current_Nm_ = 0.0, temperature_C_;
  std::vector<const Law*> laws_, limits_;
  std::array<double, 256> history_{};
  std::size_t newest_ = 0;
};

// The angle as the controller reads it: mean of both motors.
class MeasuredAngle {
 public:
  explicit MeasuredAngle(const Edits& edits) {
    for (const auto& edit : edits.sensors) {
      if (edit.channel != "motor_left_position_rad" && edit.channel != "motor_right_position_rad") continue;
      if (edit.kind == SensorEdit::Kind::gain) gain_ += 0.5 * (edit.value - 1.0);
      if (edit.kind == SensorEdit::Kind::offset) offset_ += 0.5 * edit.value;
      if (edit.kind == SensorEdit::Kind::law) laws_.push_back(&edit.law);
    }
  }
  double operator()(const PlantState& s) const { return read(s.rotor_rad(), s.rotor_radps()); }

  // True angle of a leg at rest whose reading is `read_rad`, by fixed-point iteration.
  double behind(double read_rad) const {
    double angle_rad = read_rad;
    for (int i = 0; i < 4; ++i) angle_rad += read_rad - read(angle_rad, 0.0);
    return angle_rad;
  }

 private:
  double read(double rotor_rad, double rotor_radps) const {
    const double angle = gain_ * rotor_rad + offset_;
    return laws_.empty() ? angle
                         : angle + 0.5 * sum_of(laws_, SensorState{.value = angle, .rate = rotor_radps});
  }

  double gain_ = 1.0, offset_ = 0.0;
  std::vector<const Law*> laws_;
};

// Speed of the motors as the controller reads it, through the encoder's low-pass. RecordedController uses the
// same filter. A recorded filter that differs becomes part of the residual command.
class MeasuredRate {
 public:
  explicit MeasuredRate(const HopperRun& run) : rate_radps_(run.start.angular_velocity_radps) {
    const double bandwidth_Hz = run.world.sensors.encoder_velocity_bandwidth_Hz;
    if (bandwidth_Hz <= 0.0) return;
    const double ratio = 2.0 * std::numbers::pi * bandwidth_Hz * run.step_s;
    decay_ = std::exp(-ratio);
    slope_gain_ = 1.0 - (1.0 - decay_) / ratio;
  }

  // One grid step further; exact for a speed that is linear over it.
  void follow(double rate_radps) {
    rate_radps_ =
        decay_ * rate_radps_ + (1.0 - decay_) * now_radps_ + slope_gain_ * (rate_radps - now_radps_);
    now_radps_ = rate_radps;
  }
  double operator()() const { return rate_radps_; }

 private:
  double rate_radps_, now_radps_ = rate_radps_, decay_ = 0.0, slope_gain_ = 1.0;
};

// The believed controller on the simulated leg; see HopperRun for what else can drive it.
class SpringLeg {
 public:
  SpringLeg(const HopperRun& run, const Leg& leg, const LegTable& table)
      : run_(run),
        leg_(leg),
        table_(table),
        own_(run.world.controller, run.compression_stiffness_N_per_m),
        rate_(run) {}

  void follow(double rate_radps) { rate_.follow(rate_radps); }

  double command_Nm(double time_s, double angle_rad, const PlantState& state) {
    const auto& world = run_.world;
    const double limit = world.motor.torque_limit_Nm * world.robot.leg.motor_count;
    if (run_.recorded_command_Nm != nullptr)
      return std::clamp(run_.recorded_command_Nm->at(time_s), -limit, limit);
    if (run_.phases == nullptr || run_.phases->empty())
      return std::clamp(own_.step(leg_, {state.foot_z_m, angle_rad, rate_()}), -limit, limit);
    const double own =
        spring_torque_Nm(world, run_.compression_stiffness_N_per_m,
                         {phase_at(*run_.phases, time_s), table_.kinematics(angle_rad), rate_()});
    const double residual = run_.command_residual_Nm != nullptr ? run_.command_residual_Nm->at(time_s) : 0.0;
    return std::clamp(own + residual, -limit, limit);
  }

 private:
  const HopperRun& run_;
  const Leg& leg_;
  const LegTable& table_;
  NominalController own_;
  MeasuredRate rate_;
};

HopperTraces empty_traces(double from_s, double step_s, std::size_t count) {
  HopperTraces traces;
  for (Signal* signal : {&traces.angle_rad, &traces.rate_radps, &traces.current_torque_Nm,
                         &traces.command_torque_Nm, &traces.body_accel_mps2, &traces.foot_accel_mps2,
                         &traces.body_z_m, &traces.foot_z_m, &traces.foot_velocity_mps, &traces.force_N}) {
    signal->start_s = from_s;
    signal->step_s = step_s;
    signal->values.resize(count);
  }
  return traces;
}

// Start in the plant's coordinates, with height 0 at the surface. The recorded angle is that of the rotors.
// They rest at the side of the play to which the motors push.
PlantState start_of(const HopperRun& run, const MeasuredAngle& measured, double surface_m,
                    SpringLeg& spring) {
  PlantState start = run.start;
  start.foot_z_m -= surface_m;
  start.angle_rad = measured.behind(start.angle_rad);
  const double play_rad = run.world.robot.joint_play_rad;
  if (play_rad > 0.0) {
    start.play_rad = std::copysign(0.5 * play_rad, spring.command_Nm(run.from_s, measured(start), start));
    start.angle_rad -= start.play_rad;
  }
  return start;
}

// Writes the plant's motion in each step to the traces. Force and accelerations are means over a step on a
// bed: they jump when the bed begins to yield again, and a mean changes smoothly when that instant moves. On
// rigid ground they are values at the instant, because the foot stops by an impulse, which is no
// acceleration.
class Writer {
 public:
  Writer(HopperTraces& traces, const Plant& plant, double surface_m, bool means)
      : traces_(traces), plant_(plant), surface_m_(surface_m), means_(means) {
    if (!means_) return;
    for (Signal* signal : {&traces.body_accel_mps2, &traces.foot_accel_mps2, &traces.force_N}) {
      signal->start_s += 0.5 * signal->step_s;
      signal->means = true;
    }
  }

  void before_step(std::size_t i, double command_Nm) {
    const PlantState& state = plant_.state();
    traces_.angle_rad.values[i] = state.rotor_rad();
    traces_.rate_radps.values[i] = state.rotor_radps();
    traces_.command_torque_Nm.values[i] = command_Nm;
    traces_.foot_z_m.values[i] = state.foot_z_m + surface_m_;
    traces_.foot_velocity_mps.values[i] = state.foot_velocity_mps;
    foot_velocity_mps_ = state.foot_velocity_mps;
    impulse_Ns_ = plant_.contact_impulse_Ns();
  }

  void after_step(std::size_t i, const PlantMotion& motion) {
    const double step_s = traces_.force_N.step_s;
    traces_.body_z_m.values[i] = motion.body_z_m + surface_m_;
    if (!means_) {
      traces_.body_accel_mps2.values[i] = motion.body_accel_mps2;
      traces_.foot_accel_mps2.values[i] = motion.foot_accel_mps2;
      traces_.force_N.values[i] = motion.contact_force_N;
      return;
    }
    if (i > 0)
      traces_.body_accel_mps2.values[i - 1] = (motion.body_velocity_mps - body_velocity_mps_) / step_s;
    body_velocity_mps_ = motion.body_velocity_mps;
    traces_.foot_accel_mps2.values[i] = (plant_.state().foot_velocity_mps - foot_velocity_mps_) / step_s;
    traces_.force_N.values[i] = (plant_.contact_impulse_Ns() - impulse_Ns_) / step_s;
  }

  void end() {
    auto& accel = traces_.body_accel_mps2.values;
    if (means_) accel[accel.size() - 1] = accel[accel.size() - 2];
  }

 private:
  HopperTraces& traces_;
  const Plant& plant_;
  double surface_m_;
  bool means_;
  double foot_velocity_mps_ = 0.0, impulse_Ns_ = 0.0, body_velocity_mps_ = 0.0;
};

}  // namespace

HopperPhase phase_at(const std::vector<PhaseChange>& phases, double time_s) {
  HopperPhase phase = phases.empty() ? HopperPhase::flight : phases.front().phase;
  for (const auto& change : phases)
    if (change.time_s <= time_s + 1e-6) phase = change.phase;
  return phase;
}

double spring_torque_Nm(const WorldConfig& world, double compression_stiffness_N_per_m,
                        const SpringState& at) {
  const auto& c = world.controller;
  double k = c.flight_stiffness_N_per_m, length = c.compression_length_m, b = c.flight_damping_N_s_per_m;
  if (at.phase != HopperPhase::flight) b = c.stance_damping_N_s_per_m;
  if (at.phase == HopperPhase::compression) k = compression_stiffness_N_per_m;
  if (at.phase == HopperPhase::extension) {
    k = c.extension_stiffness_N_per_m;
    length = c.extension_length_m;
  }
  const double force = k * (length - at.leg.length_m) - b * at.leg.dlength_m_per_rad * at.rate_radps;
  const double limit = world.motor.torque_limit_Nm * world.robot.leg.motor_count;
  return std::clamp(force * at.leg.dlength_m_per_rad, -limit, limit);
}

HopperTraces simulate_hopper(const HopperRun& run, const Edits& edits) {
  GroundLaws ground(edits, run.bed_history);
  PortLaws ports(edits);
  Bed bed(run.world.terrain, run.world.robot.leg.foot_radius_m, run.fluctuation);
  if (!ground.empty()) bed.extend(&ground);
  Plant::Options options;
  options.cable_force_N = run.cable_force_N;
  options.friction_switch_factor = run.friction_switch_factor;
  if (!ports.empty()) options.extension = &ports;
  const auto table = leg_table(Leg(run.world.robot.leg));
  options.leg_table = table.get();
  Plant plant(run.world, bed, options);
  const double surface_m = run.surface_m + ground.deeper_m();
  SpringLeg spring(run, plant.leg(), *table);
  Actuator actuator(edits, run);
  const MeasuredAngle measured(edits);
  plant.place_in_crater(start_of(run, measured, surface_m, spring), run.crater_m);

  const double step_s = run.step_s;
  const auto count = static_cast<std::size_t>(std::ceil((run.to_s - run.from_s) / step_s)) + 2;
  const double tick_s = 1.0 / run.world.controller.rate_Hz;
  const auto per_tick = static_cast<std::size_t>(std::max(1.0, std::round(tick_s / step_s)));
  HopperTraces traces = empty_traces(run.from_s, step_s, count);
  Writer writer(traces, plant, surface_m, !run.world.terrain.rigid);
  double command_Nm = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = run.from_s + step_s * static_cast<double>(i);
    ground.at_time(t);
    ports.at_time(t);
    const PlantState& state = plant.state();
    ground.touching(state.foot_z_m < 0.0);
    if (i > 0) spring.follow(state.rotor_radps());
    const bool switched = run.switch_between_cycles && i > 0 && run.phases != nullptr &&
                          phase_at(*run.phases, t) != phase_at(*run.phases, t - step_s);
    if (i % per_tick == 0 || switched) command_Nm = spring.command_Nm(t, measured(state), state);
    traces.current_torque_Nm.values[i] = actuator.current_Nm();  // read before the command acts
    const double torque_Nm = actuator.torque_Nm(actuator.step(command_Nm, state.rotor_radps()), t);
    writer.before_step(i, command_Nm);
    writer.after_step(i, plant.advance(torque_Nm, step_s));
  }
  writer.end();
  return traces;
}

}  // namespace sandhopper::diagnose
