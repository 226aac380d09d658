#include "tools/campaign/belief_notes.hpp"

#include <algorithm>
#include <array>

#include "config/hint.hpp"

namespace sandhopper {
namespace {

struct Note {
  std::string_view key;  // table.key
  std::string_view does;
  std::string_view reason;
};

constexpr std::string_view kOff = "0: not assumed";
constexpr std::string_view kRobot = "of this project's robot";
constexpr std::string_view kUnless = "a number is needed; state your own";

constexpr std::array kNotes{
    Note{".gravity_mps2", "gravity", "standard gravity of the laboratory"},
    Note{"axis.inertia_kg_m2",
         "moment of inertia about the axis, on the output side; 0 only where the axis is locked", kUnless},
    Note{"axis.gravity_torque_Nm", "m g l, held at a right angle; 0 degrees hangs down", kOff},
    Note{"axis.viscous_friction_Nm_s", "friction per speed", kOff},
    Note{"axis.coulomb_friction_Nm", "friction of either direction", kOff},
    Note{"axis.friction_switch_speed_radps", "speed within which Coulomb friction changes sign",
         "smooths the sign; without Coulomb friction it does nothing"},
    Note{"axis.gear_ratio", "information: torque and inertia are those of the output", "direct drive"},
    Note{"body.mass_kg", "mass of the body", kUnless},
    Note{"body.frontal_area_m2", "area against the motion, for drag and impact", kOff},
    Note{"body.volume_m3", "volume, for buoyancy and added mass", kOff},
    Note{"bed.surface_height_m", "height at which the body meets the bed", "the height's zero"},
    Note{"bed.stiffness_N_per_m", "linear spring of the bed; 0: no bed", kOff},
    Note{"medium.density_kg_per_m3", "of the air or liquid", kOff},
    Note{"medium.drag_coefficient", "C_d of 1/2 rho A C_d v^2", kOff},
    Note{"medium.linear_drag_N_s_per_m", "drag per speed", kOff},
    Note{"medium.buoyancy_factor", "1: the displaced weight", kOff},
    Note{"medium.added_mass_factor", "C_m: C_m rho V moves along (0.5 for a sphere)", kOff},
    Note{"medium.surface_height_m", "the medium is below it", "everywhere"},
    Note{"foot.radius_m", "radius of the plate or foot", kUnless},
    Note{"rig.stiffness_N_per_m", "of the rig between foot and depth sensor; none: rigid", "rigid"},
    Note{"terrain.stiffness_N_per_m", "force per depth of the bed under the foot", kUnless},
    Note{"terrain.intercept_depth_m", "z0 of the depth law: how far the line's start lies above the surface",
         kOff},
    Note{"terrain.intercept_growth_depth_m", "depth over which z0 builds up", "without z0 it does nothing"},
    Note{"terrain.bulk_density_kg_per_m3", "of the bed, for added mass and drag",
         "dry sand; without added mass and drag it does nothing"},
    Note{"terrain.added_mass_factor", "grains that move along with the foot; 0: none", kOff},
    Note{"terrain.drag_factor", "drag of the growing cone of grains; 0: none", kOff},
    Note{"terrain.added_mass_recruitment", "slope of the cone's volume; Aguilar and Goldman 2016",
         "without added mass it does nothing"},
    Note{"terrain.added_mass_band_angle_deg", "angle of the cone's shear bands",
         "without added mass it does nothing"},
    Note{"terrain.steady_drag_coefficient", "lambda of lambda rho pi R^2 v^2", kOff},
    Note{"terrain.unloading_stiffness_ratio",
         "stiffness while the foot rises over that while it sinks; 1: the same line", "1: not assumed"},
    Note{"terrain.unloading_damping_ratio", "damping on the unloading line", kOff},
    Note{"terrain.added_mass_switch_speed_mps", "speed at which the added mass is fully there",
         "without added mass it does nothing"},
    Note{"terrain.stiffness_per_area_N_per_m3",
         "K of K A z (z / 1 cm)^(n-1), in place of stiffness_N_per_m; 0: not used", kOff},
    Note{"terrain.exponent", "n of that law", "a straight line"},
    Note{"terrain.rigid", "the foot stands still in stance", "a bed that gives"}};

struct Ending {
  std::string_view end;
  std::string_view does;
};
constexpr std::array kEndings{Ending{"_bandwidth_Hz", "first-order low pass; 0: none"},
                              Ending{"_rate_Hz", "samples a second; 0: every row"},
                              Ending{"_latency_s", "the sensor's delay"},
                              Ending{"_bits", "of the converter over its range; 0: no steps"},
                              Ending{"_per_rev", "counts or periods of one turn"}};

std::string sensor_note(std::string_view key) {
  for (const auto& ending : kEndings)
    if (key.ends_with(ending.end)) return std::string(ending.does);
  if (key.find("_noise_") != std::string_view::npos) return "noise, rms of one sample";
  if (key.find("_range_") != std::string_view::npos) return "end of the sensor's range, either sign; 0: none";
  if (key.find("_resolution_") != std::string_view::npos) return "step of the readings";
  return "";
}

}  // namespace

std::string belief_unit(std::string_view key) { return key.ends_with("_Nm_s") ? "N m s" : unit_of_key(key); }

BeliefNote belief_note(std::string_view table, std::string_view key) {
  const std::string name = std::string(table) + "." + std::string(key);
  const auto found =
      std::find_if(kNotes.begin(), kNotes.end(), [&](const Note& note) { return note.key == name; });
  if (found != kNotes.end()) return {std::string(found->does), std::string(found->reason)};
  if (table == "sensors") return {sensor_note(key), "of the sensors of this project's robot"};
  if (table == "spread") return {"one standard deviation from trial to trial", "of this project's robot"};
  return {"", std::string(kRobot)};
}

}  // namespace sandhopper
