#include "tools/plant/fixture.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper {

double Fixture::tap_at(double since_set_s) const noexcept {
  const double number = std::floor(since_set_s / tap_period_s);
  if (number < 1.0 || number > taps) return 0.0;
  const double phase = (since_set_s - number * tap_period_s) / tap_length_s;
  return phase < 1.0 ? std::sin(std::numbers::pi * phase) : 0.0;
}

double Fixture::swing_at(double since_set_s) const noexcept {
  return 0.5 * leg_swing_rad * (1.0 - std::cos(2.0 * std::numbers::pi * since_set_s / leg_swing_period_s));
}

double PressedTorque::follow(double motor_torque_Nm, double friction_Nm) noexcept {
  return torque_Nm_ = std::clamp(torque_Nm_, motor_torque_Nm - friction_Nm, motor_torque_Nm + friction_Nm);
}

}  // namespace sandhopper
