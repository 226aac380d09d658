#include "firmware/controller.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

bool drives_on(State state) noexcept { return state != State::idle && state != State::fault; }

bool hopping(State state) noexcept {
  return state == State::flight || state == State::compression || state == State::extension;
}

// A body that accelerates less than this is carried by its leg. The estimated speed cannot be used instead:
// after an impact beyond the accelerometers' range it is wrong by about 0.5 m/s.
constexpr double kSupported_mps2 = 3.0;

}  // namespace

Controller::Controller(const CycleConfig& config)
    : config_(config),
      leg_(config_.robot),
      estimator_(config_, leg_),
      arming_(config_, leg_),
      recorder_(config_.stiffness, foot_in_flight(config_, leg_)),
      supervisor_(config_, leg_),
      reaction_(config_) {
  if (config_.start.fault == Fault::none) return;
  out_.fault = config_.start.fault;
  out_.state = State::fault;
  fault_of_last_run_ = true;
}

const StepOutput& Controller::step(const SensorFrame& frame) noexcept {
  event_count_ = 0;
  stride_finished_ = hopping_ = false;
  out_.time_ns = frame.time_ns;
  out_.cycle = frame.cycle;

  if (frame.wall_clock_step_ns != 0)
    emit(EventKind::clock_stepped, Reason::date_changed, {to_s(frame.wall_clock_step_ns), 0.0, 0.0, 0.0});
  request_had_effect_ = serve_request(frame);
  if (estimating()) {
    estimator_.update(frame, out_.estimate);
    out_.estimate.surface_z_m = recorder_.surface_z_m();
  }
  supervise(frame);
  if (out_.state == State::armed) step_armed(frame);
  if (hopping(out_.state)) step_hop(frame);
  if (out_.state == State::soft_stop) step_soft_stop(frame);
  out_.stride = recorder_.strides_begun();
  write_command(frame);
  return out_;
}

bool Controller::estimating() const noexcept {
  return ready_ || hopping(out_.state) || out_.state == State::soft_stop;
}

double Controller::time_in_state_s(const SensorFrame& frame) const noexcept {
  return to_s(frame.time_ns - state_since_ns_);
}

// A soft stop may also take the time for settling and for the ramp.
double Controller::phase_time_s(const SensorFrame& frame) const noexcept {
  if (hopping(out_.state)) return time_in_state_s(frame);
  if (out_.state != State::soft_stop) return 0.0;
  return time_in_state_s(frame) - config_.limits.settle_s - config_.limits.ramp_down_s;
}

LegObservation Controller::observation() const noexcept {
  const auto& e = out_.estimate;
  return {.leg_length_m = e.leg_length_m,
          .leg_rate_mps = e.leg_rate_mps,
          .foot_z_m = e.foot_z_m,
          .body_velocity_mps = e.body_velocity_mps,
          .surface_z_m = recorder_.surface_z_m()};
}

void Controller::emit(EventKind kind, Reason reason, const std::array<double, 4>& values) noexcept {
  if (event_count_ == events_.size()) return;
  events_[event_count_++] = {.time_ns = out_.time_ns,
                             .kind = kind,
                             .reason = reason,
                             .fault = out_.fault,
                             .stride = recorder_.strides_begun(),
                             .values = values};
}

void Controller::enter(State state, const SensorFrame& frame) noexcept {
  out_.state = state;
  state_since_ns_ = still_since_ns_ = frame.time_ns;
}

bool Controller::serve_request(const SensorFrame& frame) noexcept {
  switch (frame.request) {
    case Request::arm:
      if (out_.state == State::fault)
        emit(EventKind::arming_refused, Reason::fault, {fault_values_[0], fault_values_[1], 0.0, 0.0});
      if (out_.state != State::idle) return false;
      arming_.begin(frame.time_ns);
      ready_ = stop_requested_ = false;
      free_fall_count_ = 0;
      out_.command.open_catch = false;
      enter(State::armed, frame);
      return true;
    case Request::release:
      if (out_.state != State::armed || !ready_) return false;
      out_.command.open_catch = true;
      return true;
    case Request::stop:
      if (!drives_on(out_.state) || out_.state == State::soft_stop) return false;
      emit(EventKind::stop_requested, Reason::operator_request, {});
      stop_requested_ = true;
      if (out_.state == State::armed) enter(out_.command.open_catch ? State::soft_stop : State::idle, frame);
      if (out_.state == State::compression || out_.state == State::extension) enter(State::soft_stop, frame);
      return true;
    case Request::disarm:
      return disarm(frame);
    case Request::none:
      return false;
  }
  return false;
}

bool Controller::disarm(const SensorFrame& frame) noexcept {
  if (out_.state != State::fault && out_.state != State::armed && out_.state != State::idle) return false;
  // A fault of the last run may have asked for a restart. That restart has taken place.
  const Latch latch = fault_of_last_run_ ? Latch::until_disarmed : entry_of(out_.fault).latch;
  if (latch == Latch::until_restart || (latch == Latch::until_released && frame.emergency_stop)) {
    emit(EventKind::disarm_refused, Reason::fault, {fault_values_[0], fault_values_[1], 0.0, 0.0});
    return false;
  }
  out_.fault = Fault::none;
  fault_of_last_run_ = false;
  ready_ = false;
  enter(State::idle, frame);
  emit(EventKind::disarmed, Reason::operator_request, {});
  return true;
}

void Controller::supervise(const SensorFrame& frame) noexcept {
  const auto found =
      supervisor_.check(frame, out_.estimate,
                        {.state = out_.state,
                         .phase_time_s = phase_time_s(frame),
                         .estimating = estimating(),
                         .energised = drives_on(out_.state) && (out_.state != State::armed || ready_),
                         .touchdowns = touchdowns(),
                         .command = out_.command});
  if (found.fault != Fault::none) raise(found, frame);
}

// A harsher fault replaces a gentler one. If only its latch is harsher, the running reaction continues.
void Controller::raise(const FaultFound& found, const SensorFrame& frame) noexcept {
  const Reaction reaction = entry_of(found.fault).reaction;
  if (out_.fault != Fault::none && !is_harsher(found.fault, out_.fault)) return;
  const bool reacting = out_.state == State::fault && reaction == entry_of(out_.fault).reaction;
  out_.fault = found.fault;
  fault_of_last_run_ = false;
  fault_values_ = found.values;
  emit(EventKind::fault_raised, Reason::fault, {found.values[0], found.values[1], 0.0, 0.0});
  const bool standing = out_.state == State::compression || out_.state == State::extension;
  if (reaction == Reaction::stop && (hopping(out_.state) || out_.state == State::soft_stop)) {
    stop_requested_ = true;
    if (standing) enter(State::soft_stop, frame);
    return;
  }
  if (reacting) return;
  // Before the check at arming has passed, the drives produce at most its small torque. Then nothing needs
  // damping.
  const bool energised = out_.command.drive == DriveRequest::run && (out_.state != State::armed || ready_);
  if (out_.state != State::fault) reaction_.begin(frame, energised);
  ready_ = false;
  enter(State::fault, frame);
}

void Controller::step_armed(const SensorFrame& frame) noexcept {
  if (!ready_) {
    const auto verdict = arming_.update(frame);
    if (!verdict) return;
    if (!verdict->passed) {
      emit(EventKind::arming_refused, verdict->reason, verdict->values);
      enter(State::idle, frame);
      return;
    }
    emit(EventKind::zero_check, verdict->reason, verdict->values);
    emit(EventKind::armed, Reason::zero_confirmed, {});
    estimator_.start(verdict->calibration, frame);
    body_bias_mps2_ = verdict->calibration.body_bias_mps2;
    recorder_.on_release(frame.time_ns);
    ready_ = true;
    return;
  }
  const double body_force = frame.imu_body.accel_mps2[2] - body_bias_mps2_;
  free_fall_count_ = body_force < config_.arming.free_fall_accel_mps2 ? free_fall_count_ + 1 : 0;
  if (free_fall_count_ < config_.arming.free_fall_cycles) return;
  const auto& e = out_.estimate;
  emit(EventKind::released, out_.command.open_catch ? Reason::catch_opened : Reason::free_fall,
       {body_force, e.foot_z_m, e.body_z_m, 0.0});
  ready_ = false;
  estimator_.hold_force_at_zero(false);
  recorder_.on_release(frame.time_ns);
  enter(State::flight, frame);
}

void Controller::step_hop(const SensorFrame& frame) noexcept {
  recorder_.update(out_.estimate, out_.state);
  hopping_ = true;
  if (const auto transition = next_phase(out_.state, observation(), config_.controller)) {
    apply(*transition, frame);
    return;
  }
  // With too little energy to lift off again the robot rests on the ground. This is no fault; the hop is
  // over.
  if (out_.state == State::flight || !still()) still_since_ns_ = frame.time_ns;
  if (to_s(frame.time_ns - still_since_ns_) <= config_.limits.settle_s) return;
  const auto& e = out_.estimate;
  emit(EventKind::stop_requested, Reason::settled,
       {e.leg_length_m, e.leg_rate_mps, e.foot_z_m, e.foot_velocity_mps});
  enter(State::soft_stop, frame);
}

bool Controller::still() const noexcept {
  const auto& e = out_.estimate;
  return std::abs(e.leg_rate_mps) < config_.limits.settled_speed_mps &&
         std::abs(e.body_accel_mps2) < kSupported_mps2;
}

void Controller::apply(const Transition& transition, const SensorFrame& frame) noexcept {
  const auto& e = out_.estimate;
  const std::array<double, 4> values{e.leg_length_m, e.leg_rate_mps, e.foot_z_m, e.foot_velocity_mps};
  const bool done = recorder_.strides_begun() >= static_cast<std::uint32_t>(config_.limits.strides);
  if (transition.to == State::compression && (done || stop_requested_)) {
    emit(transition.event, done ? Reason::strides_done : Reason::operator_request, values);
    enter(State::soft_stop, frame);
    return;
  }
  if (transition.to == State::compression) recorder_.on_touchdown(frame.time_ns);
  if (transition.to == State::extension) recorder_.on_switch(frame.time_ns);
  if (transition.to == State::flight) {
    recorder_.on_liftoff(frame.time_ns);
    stride_finished_ = true;
  }
  emit(transition.event, transition.reason, values);
  enter(transition.to, frame);
}

void Controller::step_soft_stop(const SensorFrame& frame) noexcept {
  const auto& e = out_.estimate;
  const double still_s = to_s(frame.time_ns - still_since_ns_);
  const bool ramping = still_s > config_.limits.settle_s;
  if (!still() && !ramping) still_since_ns_ = frame.time_ns;
  if (still_s <= config_.limits.settle_s + config_.limits.ramp_down_s) return;
  emit(EventKind::stopped, Reason::settled,
       {e.leg_length_m, e.leg_rate_mps, e.foot_z_m, e.foot_velocity_mps});
  reaction_.begin(frame, false);
  enter(out_.fault == Fault::none ? State::idle : State::fault, frame);
}

void Controller::write_command(const SensorFrame& frame) noexcept {
  out_.command.motor = {};
  if (out_.state == State::idle) {
    out_.command.drive = DriveRequest::off;
    return;
  }
  if (out_.state == State::fault) {
    reaction_.write(frame, entry_of(out_.fault).reaction, time_in_state_s(frame), out_.command);
    return;
  }
  if (out_.state == State::armed && !ready_) {
    arming_.write(out_.command);
    return;
  }
  out_.command.drive = DriveRequest::run;
  auto law = spring_law(out_.state, config_.controller);
  if (out_.state == State::soft_stop) {
    // The spring fades while the damping stays, so that the robot lowers itself instead of dropping.
    const double ramped_s = to_s(frame.time_ns - still_since_ns_) - config_.limits.settle_s;
    law.stiffness_N_per_m *= std::clamp(1.0 - ramped_s / config_.limits.ramp_down_s, 0.0, 1.0);
  }
  const double force_N = spring_force_N(law, observation());
  const auto leg = leg_.kinematics(out_.estimate.leg_angle_rad);
  const double motors = config_.robot.motor_count;
  const double limit = config_.limits.motor_torque_Nm;
  const double torque = std::clamp(force_N * leg.dlength_m_per_rad / motors, -limit, limit);
  for (std::size_t i = 0; i < static_cast<std::size_t>(config_.robot.motor_count); ++i)
    out_.command.motor[i].torque_Nm = torque;
}

}  // namespace sandhopper
