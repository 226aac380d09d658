#include "tools/campaign/key_meanings.hpp"

#include <array>

namespace sandhopper {
namespace {

constexpr std::array kModel{
    KeyMeaning{"gravity_mps2", "acceleration of gravity, downward"},

    KeyMeaning{"robot.body_mass_kg", "mass of the body with both motors' stators"},
    KeyMeaning{"robot.foot_mass_kg", "mass of the foot below the toe joint"},
    KeyMeaning{"robot.upper_link_mass_kg", "mass of one upper link"},
    KeyMeaning{"robot.lower_link_mass_kg", "mass of one lower link"},
    KeyMeaning{"robot.upper_link_length_m", "hip axis to knee"},
    KeyMeaning{"robot.lower_link_length_m", "knee to toe joint"},
    KeyMeaning{"robot.upper_link_com_m", "hip axis to the upper link's centre of mass"},
    KeyMeaning{"robot.lower_link_com_m", "knee to the lower link's centre of mass"},
    KeyMeaning{"robot.upper_link_inertia_kg_m2", "inertia of one upper link about its centre of mass"},
    KeyMeaning{"robot.lower_link_inertia_kg_m2", "inertia of one lower link about its centre of mass"},
    KeyMeaning{"robot.rotor_inertia_kg_m2", "inertia of one rotor, on the motor's side of the gear"},
    KeyMeaning{"robot.gear_ratio", "turns of the motor for one turn of the upper link; 1: direct drive"},
    KeyMeaning{"robot.motor_count", "motors that drive the leg: 2, or 1 that moves both sides"},
    KeyMeaning{"robot.hip_offset_m", "half the distance between the two hip axes"},
    KeyMeaning{"robot.foot_height_m", "sole to toe joint"},
    KeyMeaning{"robot.foot_radius_m",
               "radius of the round sole; with the bed's density it sets the added mass"},
    KeyMeaning{"robot.rail_coulomb_N", "dry friction of the vertical rail"},
    KeyMeaning{"robot.rail_viscous_N_s_per_m", "friction of the rail in proportion to speed"},
    KeyMeaning{"robot.joint_coulomb_Nm", "dry friction of one motor's joint, on the link's side"},
    KeyMeaning{
        "robot.rail_friction_switch_speed_mps",
        "v_s of c tanh(speed / v_s): below it the rail's dry friction fades out as the body turns round"},
    KeyMeaning{"robot.joint_friction_switch_speed_radps", "the same for the joints' dry friction"},
    KeyMeaning{"robot.cogging_amplitude_Nm", "amplitude of one motor's cogging torque; 0: none"},
    KeyMeaning{"robot.cogging_periods_per_rev", "periods of the cogging torque in one turn of the link"},
    KeyMeaning{"robot.series_compliance_m_per_N",
               "how far a spring between toe joint and foot yields; 0: rigid"},
    KeyMeaning{"robot.series_damping_ratio", "damping ratio of the foot on that spring"},
    KeyMeaning{"robot.joint_play_rad", "play (backlash) between rotor and link; 0: none"},
    KeyMeaning{"robot.joint_give_relative",
               "how far 1 N m turns gear teeth that touch, as a share of the play; used only with play"},

    KeyMeaning{"motor.torque_constant_Nm_per_A", "torque on the link's side for 1 A of current"},
    KeyMeaning{"motor.torque_limit_Nm", "greatest torque of one motor, on the link's side"},
    KeyMeaning{"motor.current_loop_time_constant_s",
               "time constant with which the torque follows its command"},

    KeyMeaning{"controller.rate_Hz", "rate of the controller's cycle"},
    KeyMeaning{"controller.compression_length_m", "neutral leg length of the virtual spring in compression"},
    KeyMeaning{"controller.extension_length_m", "neutral leg length of the virtual spring in extension"},
    KeyMeaning{"controller.extension_stiffness_N_per_m", "stiffness of the virtual spring in extension"},
    KeyMeaning{"controller.stance_damping_N_s_per_m", "damping of the virtual spring in stance"},
    KeyMeaning{"controller.flight_stiffness_N_per_m", "stiffness of the virtual spring in flight"},
    KeyMeaning{"controller.flight_damping_N_s_per_m", "damping of the virtual spring in flight"},
    KeyMeaning{"controller.touchdown_deflection_m",
               "touchdown is declared when the leg is shorter than its neutral length by more than this"},
    KeyMeaning{"controller.touchdown_rate_mps", "or shortens faster than this"},
    KeyMeaning{"controller.compression_end_min_deflection_m",
               "compression cannot end before the leg has been compressed by this much"},
    KeyMeaning{"controller.liftoff_margin_m",
               "liftoff is declared when the leg is within this of its neutral length in extension"},

    KeyMeaning{"terrain.stiffness_N_per_m",
               "k: slope of the quasi-static force over depth, F = k (z + z0 (1 - exp(-z / dz0)))"},
    KeyMeaning{"terrain.intercept_depth_m",
               "z0: depth that the linear part seems to start above the surface"},
    KeyMeaning{"terrain.intercept_growth_depth_m", "dz0: depth over which z0 comes into effect"},
    KeyMeaning{"terrain.bulk_density_kg_per_m3", "density of the bed, grains and gaps together"},
    KeyMeaning{
        "terrain.added_mass_factor",
        "c_g: multiplies the mass of grains that moves with the foot; 0: no added mass and no drag from it"},
    KeyMeaning{"terrain.drag_factor",
               "c_d: drag force over (added-mass gradient x speed^2); 0: no such drag"},
    KeyMeaning{"terrain.added_mass_recruitment",
               "nu: how many times its own volume the cone of grains under the foot recruits"},
    KeyMeaning{
        "terrain.added_mass_band_angle_deg",
        "theta: angle of the cone's shear band to the horizontal; with nu it sets how deep the cone grows"},
    KeyMeaning{"terrain.steady_drag_coefficient",
               "lambda: drag lambda rho A v^2 that stays at every depth; 0: none"},
    KeyMeaning{"terrain.unloading_stiffness_ratio",
               "r: stiffness of the line on which the force falls when the foot goes up again, over k"},
    KeyMeaning{"terrain.unloading_damping_ratio", "zeta: damping ratio of the moving mass on that line"},
    KeyMeaning{"terrain.added_mass_switch_speed_mps",
               "speed below which the added mass fades out, so that a foot that turns round meets no jump"},
    KeyMeaning{
        "terrain.stiffness_per_area_N_per_m3",
        "K: where above 0, F = K A z (z / 1 cm)^(n - 1) with the foot's area A replaces the law with k"},
    KeyMeaning{"terrain.exponent", "n of that law; used only with stiffness_per_area_N_per_m3"},
    KeyMeaning{"terrain.rigid", "true: the ground does not yield and the foot stands still in stance"},

    KeyMeaning{"foot.radius_m", "radius of the round plate that is pushed in"},
    KeyMeaning{"rig.stiffness_N_per_m",
               "stiffness k_r of the rig: the recorded depth is the plate's plus F / k_r; not set: rigid"},

    KeyMeaning{"bed.surface_height_m", "height of the bed's surface in the units of height_m"},
    KeyMeaning{"bed.stiffness_N_per_m", "stiffness of the bed while the body sinks in; 0: there is no bed"},
    KeyMeaning{"body.mass_kg", "mass of the body"},
    KeyMeaning{"body.frontal_area_m2",
               "area that the medium pushes against, for the quadratic drag; diameter_m of a trial gives it"},
    KeyMeaning{"body.volume_m3",
               "volume of the body, for buoyancy and added mass; diameter_m does not give it: a ball has pi "
               "D^3 / 6"},
    KeyMeaning{"medium.density_kg_per_m3",
               "density of the air or liquid; 0: no quadratic drag, buoyancy or added mass"},
    KeyMeaning{"medium.drag_coefficient", "C_d of F = 1/2 rho A C_d v^2; 0: none"},
    KeyMeaning{"medium.linear_drag_N_s_per_m", "b of F = b v; 0: none"},
    KeyMeaning{"medium.buoyancy_factor", "B of the upward force B rho V g: 1 in a liquid at rest, 0: none"},
    KeyMeaning{"medium.added_mass_factor", "C_m of the added mass C_m rho V: 0.5 for a sphere, 0: none"},
    KeyMeaning{"medium.upward_mps",
               "steady speed at which the air or liquid rises, negative: sinks; drag acts "
               "on the speed relative to it"},
    KeyMeaning{"medium.surface_height_m", "the medium is below this height; the default means everywhere"},

    KeyMeaning{"axis.inertia_kg_m2", "inertia about the axis, on the output side, rotor and gear included"},
    KeyMeaning{"axis.gravity_torque_Nm",
               "G = m g l of the torque -G sin(position); position 0 hangs straight down; 0: balanced"},
    KeyMeaning{"axis.viscous_friction_Nm_s", "friction torque in proportion to speed"},
    KeyMeaning{"axis.coulomb_friction_Nm", "dry friction torque"},
    KeyMeaning{"axis.friction_switch_speed_radps",
               "v_s of c tanh(speed / v_s): below it dry friction fades out as the axis turns round"},
    KeyMeaning{"axis.gear_ratio",
               "turns of the motor for one turn of the output; kept for information, not used"},
};

}  // namespace

std::span<const KeyMeaning> model_key_meanings() { return kModel; }

}  // namespace sandhopper
