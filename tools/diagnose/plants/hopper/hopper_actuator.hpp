#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/plants/hopper/hopper_simulation.hpp"

namespace sandhopper::diagnose {

// From the commanded torque to the current, and from the current to the torque on the links.
class Actuator {
 public:
  Actuator(const Edits& edits, const HopperRun& run)
      : step_s_(run.step_s),
        factor_(run.torque_constant_factor),
        temperature_C_(run.motor_temperature_C),
        limits_(edits.at("actuator.limit")) {
    const double time_constant_s = run.world.motor.current_loop_time_constant_s;
    for (const auto& edit : edits.sensors) {
      if (edit.channel != "actuator") continue;
      switch (edit.kind) {
        case SensorEdit::Kind::gain:
          factor_ *= edit.value;
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
    // A loop that acts at the start of 0.1 ms steps is half a step ahead of a continuous one, and recordings
    // may be of either: between the two. Which, a tolerance finds out (plants/hopper).
    const double ahead = time_constant_s > 0.0 ? std::exp(-0.25 * Plant::kStep_s / time_constant_s) : 0.0;
    loop_mean_ = ahead * (1.0 - loop_decay_) * time_constant_s / step_s_;
  }

  // One grid step with `command` in force; returns the current (as torque of the nominal constant), mean over
  // the step.
  double step(double command_Nm, double rate_radps) {
    if (!limits_.empty()) {
      const double limit_Nm = std::max(0.0, sum_of(limits_, {.velocity = rate_radps, .load = command_Nm}));
      command_Nm = std::clamp(command_Nm, -limit_Nm, limit_Nm);
    }
    auto& history = at_.history_Nm;
    at_.newest = (at_.newest + 1) % history.size();
    history[at_.newest] = command_Nm;
    // A little early is an overshoot of the next step that holds the same impulse.
    const double steps = std::clamp(delay_s_ / step_s_, -1.0, static_cast<double>(history.size() - 2));
    const auto whole = static_cast<std::size_t>(std::max(0.0, steps));
    const double part = steps - static_cast<double>(whole);
    const auto back = [&](std::size_t n) {
      return history[(at_.newest + history.size() - n) % history.size()];
    };
    const double delayed = (1.0 - part) * back(whole) + part * back(whole + 1);
    at_.lagged_Nm = delayed + (at_.lagged_Nm - delayed) * lag_decay_;
    const double mean_Nm = at_.lagged_Nm + (at_.current_Nm - at_.lagged_Nm) * loop_mean_;
    at_.current_Nm = at_.lagged_Nm + (at_.current_Nm - at_.lagged_Nm) * loop_decay_;
    return mean_Nm;
  }

  double current_Nm() const { return at_.current_Nm; }
  const ActuatorProgress& progress() const { return at_; }
  void resume(const ActuatorProgress& at) { at_ = at; }

  double torque_Nm(double current_Nm, double time_s) const {
    double torque = factor_ * current_Nm + offset_Nm_;
    if (!laws_.empty())
      torque += sum_of(laws_, {.time_s = time_s, .position = current_Nm, .temperature_C = temperature_C_});
    return torque;
  }

 private:
  double decay(double time_constant_s) const {
    return time_constant_s > 0.0 ? std::exp(-step_s_ / time_constant_s) : 0.0;
  }

  double step_s_, factor_, offset_Nm_ = 0.0, delay_s_ = 0.0, lag_decay_ = 0.0, loop_decay_ = 0.0,
                           loop_mean_ = 0.0;
  double temperature_C_;
  std::vector<const Law*> laws_, limits_;
  ActuatorProgress at_{};
};

}  // namespace sandhopper::diagnose
