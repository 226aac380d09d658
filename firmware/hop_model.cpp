#include "firmware/hop_model.hpp"

#include <cmath>

#include "estimation/leg.hpp"

namespace sandhopper {

HopModel hop_model_of(const CycleConfig& cycle) {
  const Leg leg(cycle.robot);
  const double foot_kg =
      leg.dynamics(leg.angle_at_length(cycle.controller.compression_length_m)).reduced_mass_kg;
  const double torque_Nm = cycle.robot.motor_count * cycle.limits.motor_torque_Nm;
  return {.body_mass_kg = leg.total_mass_kg() - foot_kg,
          .foot_mass_kg = foot_kg,
          .foot_radius_m = cycle.robot.foot_radius_m,
          .compression_length_m = cycle.controller.compression_length_m,
          .extension_length_m = cycle.controller.extension_length_m,
          .extension_stiffness_N_per_m = cycle.controller.extension_stiffness_N_per_m,
          .greatest_leg_force_N =
              [leg, torque_Nm](double length_m) {
                const auto kinematics = leg.kinematics(leg.angle_at_length(length_m));
                return torque_Nm / std::abs(kinematics.dlength_m_per_rad);
              },
          .gravity_mps2 = kGravity_mps2};
}

}  // namespace sandhopper
