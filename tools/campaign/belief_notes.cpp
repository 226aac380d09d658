#include "tools/campaign/belief_notes.hpp"

#include <algorithm>
#include <array>

namespace sandhopper {
namespace {

struct Reason {
  std::string_view key;  // table.key
  std::string_view why;
};

constexpr std::string_view kOff = "0: not assumed";
constexpr std::string_view kRobot = "of this project's robot";
constexpr std::string_view kNeeded = "a number is needed; state your own";

constexpr std::array kReasons{
    Reason{"gravity_mps2", "standard gravity of the laboratory"},
    Reason{"axis.inertia_kg_m2", kNeeded},
    Reason{"axis.gravity_torque_Nm", kOff},
    Reason{"axis.viscous_friction_Nm_s", kOff},
    Reason{"axis.coulomb_friction_Nm", kOff},
    Reason{"axis.friction_switch_speed_radps", "smooths the sign; without Coulomb friction it does nothing"},
    Reason{"axis.gear_ratio", "direct drive"},
    Reason{"robot.rail_friction_switch_speed_mps",
           "smooths the sign; without dry friction it does nothing; assumed, not measured"},
    Reason{"robot.joint_friction_switch_speed_radps",
           "smooths the sign; without dry friction it does nothing; assumed, not measured"},
    Reason{"body.mass_kg", kNeeded},
    Reason{"body.frontal_area_m2", kOff},
    Reason{"body.volume_m3", kOff},
    Reason{"bed.surface_height_m", "the height's zero"},
    Reason{"bed.stiffness_N_per_m", kOff},
    Reason{"medium.density_kg_per_m3", kOff},
    Reason{"medium.drag_coefficient", kOff},
    Reason{"medium.linear_drag_N_s_per_m", kOff},
    Reason{"medium.buoyancy_factor", kOff},
    Reason{"medium.added_mass_factor", kOff},
    Reason{"medium.upward_mps", "at rest"},
    Reason{"medium.surface_height_m", "everywhere"},
    Reason{"foot.radius_m", kNeeded},
    Reason{"rig.stiffness_N_per_m", "rigid"},
    Reason{"terrain.stiffness_N_per_m", kNeeded},
    Reason{"terrain.intercept_depth_m", kOff},
    Reason{"terrain.intercept_growth_depth_m", "without z0 it does nothing"},
    Reason{"terrain.bulk_density_kg_per_m3", "dry sand; without added mass and drag it does nothing"},
    Reason{"terrain.added_mass_factor", kOff},
    Reason{"terrain.drag_factor", kOff},
    Reason{"terrain.added_mass_recruitment", "without added mass it does nothing"},
    Reason{"terrain.added_mass_band_angle_deg", "without added mass it does nothing"},
    Reason{"terrain.steady_drag_coefficient", kOff},
    Reason{"terrain.unloading_stiffness_ratio", "1: not assumed"},
    Reason{"terrain.unloading_damping_ratio", kOff},
    Reason{"terrain.added_mass_switch_speed_mps", "without added mass it does nothing"},
    Reason{"terrain.stiffness_per_area_N_per_m3", kOff},
    Reason{"terrain.exponent", "a straight line"},
    Reason{"terrain.rigid", "a bed that gives"},
    Reason{"sensors.encoder_velocity_bandwidth_Hz",
           "no low-pass; the simulated controller uses this speed, so state yours"}};

}  // namespace

std::string_view reason_of_default(std::string_view path) {
  const auto* found = std::ranges::find(kReasons, path, &Reason::key);
  if (found != kReasons.end()) return found->why;
  if (path.starts_with("sensors.")) return "of the sensors of this project's robot";
  return kRobot;
}

std::span<const std::string_view> hopper_keys() {
  static constexpr std::array<std::string_view, 17> kKeys{"robot.body_mass_kg",
                                                          "robot.foot_mass_kg",
                                                          "robot.upper_link_mass_kg",
                                                          "robot.lower_link_mass_kg",
                                                          "robot.upper_link_length_m",
                                                          "robot.lower_link_length_m",
                                                          "robot.upper_link_com_m",
                                                          "robot.lower_link_com_m",
                                                          "robot.upper_link_inertia_kg_m2",
                                                          "robot.lower_link_inertia_kg_m2",
                                                          "robot.rotor_inertia_kg_m2",
                                                          "robot.gear_ratio",
                                                          "robot.hip_offset_m",
                                                          "robot.foot_height_m",
                                                          "motor.torque_constant_Nm_per_A",
                                                          "controller.compression_length_m",
                                                          "terrain.stiffness_N_per_m"};
  return kKeys;
}

std::span<const std::string_view> hopper_controller_keys() {
  static constexpr std::array<std::string_view, 4> kKeys{
      "controller.extension_length_m", "controller.extension_stiffness_N_per_m",
      "controller.flight_stiffness_N_per_m", "controller.flight_damping_N_s_per_m"};
  return kKeys;
}

bool decides_answer(CampaignPlant plant, std::string_view path) {
  constexpr std::array<std::string_view, 6> kNumbers{"gravity_mps2",           "axis.inertia_kg_m2",
                                                     "axis.gravity_torque_Nm", "body.mass_kg",
                                                     "foot.radius_m",          "terrain.stiffness_N_per_m"};
  const auto holds = [&](std::span<const std::string_view> keys) {
    return std::ranges::find(keys, path) != keys.end();
  };
  const bool of_hopper = holds(hopper_keys()) || holds(hopper_controller_keys());
  return holds(kNumbers) || (plant == CampaignPlant::hopper && of_hopper);
}

bool is_needed(std::string_view path) { return reason_of_default(path) == kNeeded; }

}  // namespace sandhopper
