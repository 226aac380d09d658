#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/ground_laws.hpp"
#include "tools/diagnose/plants/hopper/hopper_actuator.hpp"

namespace sandhopper::diagnose {
namespace {

class PortLaws final : public PlantExtension {
 public:
  explicit PortLaws(const Edits& edits) : rail_(edits.at("rail")), joint_(edits.at("joint")) {}
  bool empty() const { return rail_.empty() && joint_.empty(); }
  void at_time(double time_s) { time_s_ = time_s; }

  double rail_force_N(double z, double v, double leg_force_N) const override {
    return rail_.empty()
               ? 0.0
               : sum_of(rail_, {.time_s = time_s_, .position = z, .velocity = v, .load = leg_force_N});
  }
  double joint_torque_Nm(const PlantState& s, double motor_torque_Nm) const override {
    if (joint_.empty()) return 0.0;
    return sum_of(joint_, {.time_s = time_s_,
                           .position = s.angle_rad,
                           .velocity = s.angular_velocity_radps,
                           .load = motor_torque_Nm});
  }

 private:
  std::vector<const Law*> rail_, joint_;
  double time_s_ = 0.0;
};

// The angle as the controller reads it: the mean of both motors'.
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

  // The angle of a leg at rest that is read as this one.
  double behind(double read_rad) const {
    double angle_rad = read_rad;
    for (int i = 0; i < 4; ++i) angle_rad += read_rad - read(angle_rad, 0.0);
    return angle_rad;
  }

 private:
  double read(double rotor_rad, double rotor_radps) const {
    const double angle = gain_ * rotor_rad + offset_;
    return laws_.empty() ? angle : angle + 0.5 * sum_of(laws_, {.position = angle, .velocity = rotor_radps});
  }

  double gain_ = 1.0, offset_ = 0.0;
  std::vector<const Law*> laws_;
};

// The motors' speed as the controller reads it, through the encoder's low-pass. Exactly the filter that
// RecordedController takes: how the recorded one differs is part of the residual command.
class MeasuredRate {
 public:
  explicit MeasuredRate(const HopperRun& run)
      : at_{run.start.angular_velocity_radps, run.start.angular_velocity_radps} {
    const double bandwidth_Hz = run.world.sensors.encoder_velocity_bandwidth_Hz;
    if (bandwidth_Hz <= 0.0) return;
    const double ratio = 2.0 * std::numbers::pi * bandwidth_Hz * run.step_s;
    decay_ = std::exp(-ratio);
    slope_gain_ = 1.0 - (1.0 - decay_) / ratio;
  }

  // One grid step further; exact for a speed that is linear over it.
  void follow(double rate_radps) {
    at_.read_radps =
        decay_ * at_.read_radps + (1.0 - decay_) * at_.now_radps + slope_gain_ * (rate_radps - at_.now_radps);
    at_.now_radps = rate_radps;
  }
  double operator()() const { return at_.read_radps; }
  const RateProgress& progress() const { return at_; }
  void resume(const RateProgress& at) { at_ = at; }

 private:
  RateProgress at_;
  double decay_ = 0.0, slope_gain_ = 1.0;
};

// The believed controller on the simulated leg; see HopperRun for what else can drive it.
class SpringLeg {
 public:
  SpringLeg(const HopperRun& run, const Leg& leg)
      : run_(run), leg_(leg), own_(run.world.controller, run.compression_stiffness_N_per_m), rate_(run) {}

  void follow(double rate_radps) { rate_.follow(rate_radps); }

  const RateProgress& rate() const { return rate_.progress(); }
  const NominalController& controller() const { return own_; }
  void resume(const HopperMoment& at) {
    rate_.resume(at.rate);
    own_ = at.controller;
  }

  double command_Nm(double time_s, double angle_rad, const PlantState& state) {
    const auto& world = run_.world;
    const double limit = world.motor.torque_limit_Nm * world.robot.leg.motor_count;
    if (run_.recorded_command_Nm != nullptr)
      return std::clamp(run_.recorded_command_Nm->at(time_s), -limit, limit);
    if (run_.phases == nullptr || run_.phases->empty())
      return std::clamp(own_.step(leg_, {state.foot_z_m, angle_rad, rate_()}), -limit, limit);
    const double own = spring_torque_Nm(world, run_.compression_stiffness_N_per_m, leg_,
                                        {phase_at(*run_.phases, time_s), angle_rad, rate_()});
    const double residual = run_.command_residual_Nm != nullptr ? run_.command_residual_Nm->at(time_s) : 0.0;
    return std::clamp(own + residual, -limit, limit);
  }

 private:
  const HopperRun& run_;
  const Leg& leg_;
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

}  // namespace

HopperPhase phase_at(const std::vector<PhaseChange>& phases, double time_s) {
  HopperPhase phase = phases.empty() ? HopperPhase::flight : phases.front().phase;
  for (const auto& change : phases)
    if (change.time_s <= time_s + 1e-6) phase = change.phase;
  return phase;
}

double spring_torque_Nm(const WorldConfig& world, double compression_stiffness_N_per_m, const Leg& leg,
                        const SpringState& at) {
  const auto& c = world.controller;
  double k = c.flight_stiffness_N_per_m, length = c.compression_length_m, b = c.flight_damping_N_s_per_m;
  if (at.phase != HopperPhase::flight) b = c.stance_damping_N_s_per_m;
  if (at.phase == HopperPhase::compression) k = compression_stiffness_N_per_m;
  if (at.phase == HopperPhase::extension) {
    k = c.extension_stiffness_N_per_m;
    length = c.extension_length_m;
  }
  const auto kinematics = leg.kinematics(at.angle_rad);
  const double force = k * (length - kinematics.length_m) - b * kinematics.dlength_m_per_rad * at.rate_radps;
  const double limit = world.motor.torque_limit_Nm * world.robot.leg.motor_count;
  return std::clamp(force * kinematics.dlength_m_per_rad, -limit, limit);
}

namespace {

// One hop, step by step.
class Simulation {
 public:
  Simulation(const HopperRun& run, const Edits& edits)
      : run_(run),
        step_s_(run.step_s),
        count_(static_cast<std::size_t>(std::ceil((run.to_s - run.from_s) / step_s_)) + 2),
        means_(!run.world.terrain.rigid),
        ground_(edits, run.bed_history),
        ports_(edits),
        surface_m_(run.surface_m + ground_.deeper_m()),
        table_(leg_table(Leg(run.world.robot.leg))),
        plant_(run.world, bed(), options()),
        spring_(run, plant_.leg()),
        actuator_(edits, run),
        measured_(edits) {
    const double tick_s = 1.0 / run.world.controller.rate_Hz;
    steps_per_tick_ = static_cast<std::size_t>(std::max(1.0, std::round(tick_s / step_s_)));
  }

  HopperTraces from_start() {
    place();
    traces_ = empty_traces(run_.from_s, step_s_, count_);
    // Force and accelerations jump where the bed begins to yield again: their means over a step do not jump
    // from one grid point to the next when that instant moves. A foot on rigid ground stops by an impulse,
    // which is no acceleration.
    if (means_)
      for (Signal* signal : {&traces_.body_accel_mps2, &traces_.foot_accel_mps2, &traces_.force_N})
        signal->start_s += 0.5 * step_s_;
    return run_on(0);
  }

  HopperTraces from(const HopperResumed& known) {
    const HopperMoment& at = *known.at;
    traces_ = *known.traces;
    while (traces_.moments.back().step > at.step) traces_.moments.pop_back();
    plant_.resume(at.plant);
    ground_.resume(at.contact);
    actuator_.resume(at.actuator);
    spring_.resume(at);
    command_Nm_ = at.command_Nm;
    body_velocity_mps_ = at.body_velocity_mps;
    return run_on(at.step);
  }

 private:
  static constexpr std::size_t kStepsBetweenMoments = 8;

  Bed bed() const {
    Bed bed(run_.world.terrain, run_.world.robot.leg.foot_radius_m, run_.fluctuation);
    if (!ground_.empty()) bed.extend(&ground_);
    return bed;
  }
  Plant::Options options() const {
    Plant::Options options;
    options.cable_force_N = run_.cable_force_N;
    if (!ports_.empty()) options.extension = &ports_;
    options.leg_table = table_.get();
    return options;
  }

  void place() {
    PlantState start = run_.start;
    start.foot_z_m -= surface_m_;  // the plant's zero is the surface
    start.angle_rad = measured_.behind(start.angle_rad);
    // Recorded is the rotors' angle; they lie at the side of the play to which the motors push.
    const double play_rad = run_.world.robot.joint_play_rad;
    if (play_rad > 0.0) {
      start.play_rad =
          std::copysign(0.5 * play_rad, spring_.command_Nm(run_.from_s, measured_(start), start));
      start.angle_rad -= start.play_rad;
    }
    plant_.place_in_crater(start, run_.crater_m);
  }

  HopperTraces run_on(std::size_t first) {
    for (std::size_t i = first; i < count_; ++i) {
      if (means_ && i % kStepsBetweenMoments == 0) remember(i);
      step(i);
    }
    if (means_) traces_.body_accel_mps2.values[count_ - 1] = traces_.body_accel_mps2.values[count_ - 2];
    traces_.bed_reached_m = plant_.bed_reached_m();
    return std::move(traces_);
  }

  void remember(std::size_t i) {
    auto& moments = traces_.moments;
    const double reached_m = plant_.bed_reached_m();
    if (!moments.empty()) {
      if (moments.back().plant.bed_reached_m == reached_m && reached_m > 0.0) return;
      if (reached_m == 0.0) moments.pop_back();
    }
    moments.push_back({i, plant_.progress(), ground_.contact(), actuator_.progress(), spring_.rate(),
                       spring_.controller(), command_Nm_, body_velocity_mps_});
  }

  void step(std::size_t i) {
    const double t = run_.from_s + step_s_ * static_cast<double>(i);
    ground_.at_time(t);
    ports_.at_time(t);
    const PlantState& state = plant_.state();
    ground_.touching(state.foot_z_m < 0.0);
    if (i > 0) spring_.follow(state.rotor_radps());
    const bool switched = run_.switch_between_cycles && i > 0 && run_.phases != nullptr &&
                          phase_at(*run_.phases, t) != phase_at(*run_.phases, t - step_s_);
    if (i % steps_per_tick_ == 0 || switched) command_Nm_ = spring_.command_Nm(t, measured_(state), state);
    traces_.current_torque_Nm.values[i] = actuator_.current_Nm();  // read before the command acts
    const double torque_Nm = actuator_.torque_Nm(actuator_.step(command_Nm_, state.rotor_radps()), t);
    traces_.angle_rad.values[i] = state.rotor_rad();
    traces_.rate_radps.values[i] = state.rotor_radps();
    traces_.command_torque_Nm.values[i] = command_Nm_;
    traces_.foot_z_m.values[i] = state.foot_z_m + surface_m_;
    traces_.foot_velocity_mps.values[i] = state.foot_velocity_mps;
    const double foot_velocity_mps = state.foot_velocity_mps, impulse_Ns = plant_.contact_impulse_Ns();
    const PlantMotion motion = plant_.advance(torque_Nm, step_s_);
    traces_.body_z_m.values[i] = motion.body_z_m + surface_m_;
    if (means_) {
      if (i > 0)
        traces_.body_accel_mps2.values[i - 1] = (motion.body_velocity_mps - body_velocity_mps_) / step_s_;
      body_velocity_mps_ = motion.body_velocity_mps;
      traces_.foot_accel_mps2.values[i] = (plant_.state().foot_velocity_mps - foot_velocity_mps) / step_s_;
      traces_.force_N.values[i] = (plant_.contact_impulse_Ns() - impulse_Ns) / step_s_;
    } else {
      traces_.body_accel_mps2.values[i] = motion.body_accel_mps2;
      traces_.foot_accel_mps2.values[i] = motion.foot_accel_mps2;
      traces_.force_N.values[i] = motion.contact_force_N;
    }
  }

  const HopperRun& run_;
  double step_s_;
  std::size_t count_, steps_per_tick_ = 1;
  bool means_;
  GroundLaws ground_;
  PortLaws ports_;
  double surface_m_;
  std::shared_ptr<const LegTable> table_;
  Plant plant_;
  SpringLeg spring_;
  Actuator actuator_;
  MeasuredAngle measured_;
  HopperTraces traces_;
  double command_Nm_ = 0.0, body_velocity_mps_ = 0.0;
};

}  // namespace

HopperTraces simulate_hopper(const HopperRun& run, const Edits& edits, const HopperResumed& from) {
  Simulation simulation(run, edits);
  return from.at != nullptr ? simulation.from(from) : simulation.from_start();
}

}  // namespace sandhopper::diagnose
