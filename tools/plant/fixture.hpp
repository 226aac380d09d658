#pragma once
#include <array>
#include <optional>

#include "config/fields.hpp"

namespace sandhopper {

// Actions on the robot while the catch holds it: weights on the load cell, the leg moved by hand, the robot
// laid on its side, taps, or foot and body clamped so that the motors press on the load cell.
struct Fixture {
  double load_N = 0.0;
  std::optional<double> leg_angle_rad{};  // empty: unchanged
  // Swing from that angle to this much more and back, as a raised cosine.
  double leg_swing_rad = 0.0;
  double leg_swing_period_s = 1.0;
  std::optional<double> body_height_m{};   // height of the hip axis over the surface; empty: unchanged
  std::array<double, 3> body_up{0, 0, 1};  // upward direction in the robot's axes, as the body's IMU measures
                                           // it
  std::array<double, 3> foot_up{0, 0, 1};  // the same for the foot's IMU
  bool clamped = false;
  // Half-sine taps along the leg, measured by both IMUs and the load cell. The first one comes tap_period_s
  // after the fixture was set.
  int taps = 0;
  double tap_period_s = 0.5;
  double tap_length_s = 0.008;
  double tap_force_N = 60.0;
  double tap_accel_mps2 = 40.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("load_N", self.load_N, Range{-1000.0, 1000.0});
    visit("leg_angle_rad", self.leg_angle_rad, Range{0.0, 3.1});
    visit("leg_swing_rad", self.leg_swing_rad, Range{0.0, 3.0});
    visit("leg_swing_period_s", self.leg_swing_period_s, Range{0.05, 60.0});
    visit("body_height_m", self.body_height_m, Range{0.0, 10.0});
    visit("body_up", self.body_up, Range{-1.0, 1.0});
    visit("foot_up", self.foot_up, Range{-1.0, 1.0});
    visit("clamped", self.clamped);
    visit("taps", self.taps, Range{0, 1000});
    visit("tap_period_s", self.tap_period_s, Range{0.02, 10.0});
    visit("tap_length_s", self.tap_length_s, Range{1e-4, 0.1});
    visit("tap_force_N", self.tap_force_N, Range{0.0, 1000.0});
    visit("tap_accel_mps2", self.tap_accel_mps2, Range{0.0, 1000.0});
  }

  // Relative strength of a tap at this time; 1 at its peak.
  double tap_at(double since_set_s) const noexcept;
  // Deviation of the leg from the start of its swing [rad].
  double swing_at(double since_set_s) const noexcept;
};

// Torque on the links of a clamped leg: it follows the motors' torque with the hysteresis of Coulomb
// friction.
class PressedTorque {
 public:
  double follow(double motor_torque_Nm, double friction_Nm) noexcept;
  void reset() noexcept { torque_Nm_ = 0.0; }

 private:
  double torque_Nm_ = 0.0;
};

}  // namespace sandhopper
