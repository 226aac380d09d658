#pragma once
#include <cstdint>

#include "drivers/samples.hpp"

namespace sandhopper {

// True values at the newest grid point, for reports, for scoring estimates, and for the camera system; the
// firmware does not use them. `contact_impulse_Ns` is the integral of the contact force since the start. Its
// difference over an interval, divided by the interval's length, is the mean force. Motion capture values are
// those of the newest camera frame, in the laboratory's frame.
struct PlantTruth {
  std::int64_t time_ns = 0;
  bool released = false;
  double body_z_m = 0.0;
  double body_velocity_mps = 0.0;
  double body_accel_mps2 = 0.0;
  double foot_z_m = 0.0;
  double foot_velocity_mps = 0.0;
  double foot_accel_mps2 = 0.0;
  double leg_angle_rad = 0.0;
  double leg_velocity_radps = 0.0;
  double leg_length_m = 0.0;
  double motor_torque_Nm = 0.0;  // both motors, on the links
  double contact_force_N = 0.0;
  double contact_impulse_Ns = 0.0;
  double max_depth_m = 0.0;
  std::int64_t mocap_time_ns = 0;
  double mocap_body_z_m = kNotMeasured;
  double mocap_foot_z_m = kNotMeasured;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("time_ns", self.time_ns);
    visit("released", self.released);
    visit("body_z_m", self.body_z_m);
    visit("body_velocity_mps", self.body_velocity_mps);
    visit("body_accel_mps2", self.body_accel_mps2);
    visit("foot_z_m", self.foot_z_m);
    visit("foot_velocity_mps", self.foot_velocity_mps);
    visit("foot_accel_mps2", self.foot_accel_mps2);
    visit("leg_angle_rad", self.leg_angle_rad);
    visit("leg_velocity_radps", self.leg_velocity_radps);
    visit("leg_length_m", self.leg_length_m);
    visit("motor_torque_Nm", self.motor_torque_Nm);
    visit("contact_force_N", self.contact_force_N);
    visit("contact_impulse_Ns", self.contact_impulse_Ns);
    visit("max_depth_m", self.max_depth_m);
    visit("mocap_time_ns", self.mocap_time_ns);
    visit("mocap_body_z_m", self.mocap_body_z_m);
    visit("mocap_foot_z_m", self.mocap_foot_z_m);
  }
};

}  // namespace sandhopper
