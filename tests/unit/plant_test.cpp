#include "tools/plant/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "config/load.hpp"
#include "tools/experiment/nominal_stride.hpp"

namespace sandhopper {
namespace {

WorldConfig frictionless() {
  WorldConfig config;
  config.robot.rail_coulomb_N = 0.0;
  config.robot.joint_coulomb_Nm = 0.0;
  config.robot.cogging_amplitude_Nm = 0.0;
  return config;
}

double touchdown_speed_mps(const NominalStride& stride) {
  for (const auto& t : stride.grid)
    if (t.foot_z_m <= 0.0) return -t.foot_velocity_mps;
  return 0.0;
}

TEST(Plant, TwoMillimetresOfFreeFallTouchAt198MillimetresPerSecond) {
  EXPECT_NEAR(
      touchdown_speed_mps(nominal_stride({.release_height_m = 0.002, .milliseconds = 60}, frictionless())),
      0.198, 0.001);
}

// Drop heights that give the touchdown speeds of the stride matrix with 4 N of rail friction.
TEST(Plant, RailFrictionCostsTheStatedSpeed) {
  struct Drop {
    double height_m, speed_mps;
  };
  for (const auto& d :
       {Drop{.0025, .2}, Drop{.0125, .45}, Drop{.0303, .7}, Drop{.0618, 1.0}, Drop{.0890, 1.2}})
    EXPECT_NEAR(touchdown_speed_mps(nominal_stride({.release_height_m = d.height_m})), d.speed_mps,
                0.055 * d.speed_mps);
}

// Energy of the moving parts, of the spring between toe and foot, and of the joint's teeth.
double energy_J(const Plant& plant, const WorldRobotConfig& robot) {
  const auto& s = plant.state();
  const double toe_z_m = s.foot_z_m - s.series_m, toe_mps = s.foot_velocity_mps - s.series_mps;
  double sum = mechanical_energy_J(plant.leg(), toe_z_m, toe_mps, s.angle_rad, s.angular_velocity_radps);
  sum += robot.leg.foot_mass_kg *
         (0.5 * (std::pow(s.foot_velocity_mps, 2) - std::pow(toe_mps, 2)) + kGravity_mps2 * s.series_m);
  if (robot.series_compliance_m_per_N > 0.0)
    sum += 0.5 * s.series_m * s.series_m / robot.series_compliance_m_per_N;
  const double rotors_kg_m2 = 2.0 * robot.leg.rotor_inertia_kg_m2;
  sum += 0.5 * rotors_kg_m2 * (std::pow(s.rotor_radps(), 2) - std::pow(s.angular_velocity_radps, 2));
  const double pressed = std::max(0.0, std::abs(s.play_rad) - 0.5 * robot.joint_play_rad);
  if (robot.joint_play_rad > 0.0)
    sum += 0.5 * pressed * pressed / (robot.joint_give_relative * robot.joint_play_rad);
  return sum;
}

// Power of all forces that store no energy: motors, friction, rail, ground, and damping of spring and teeth.
double power_W(const Plant& plant, const WorldRobotConfig& robot, double torque_Nm) {
  const auto& s = plant.state();
  const auto m = plant.motion(torque_Nm);
  double sum = m.contact_force_N * s.foot_velocity_mps + m.rail_force_N * m.body_velocity_mps +
               torque_Nm * s.rotor_radps() + m.joint_torque_Nm * s.angular_velocity_radps;
  if (robot.series_compliance_m_per_N > 0.0)
    sum -= 2.0 * robot.series_damping_ratio *
           std::sqrt(robot.leg.foot_mass_kg / robot.series_compliance_m_per_N) * s.series_mps * s.series_mps;
  if (robot.joint_play_rad > 0.0 && std::abs(s.play_rad) > 0.5 * robot.joint_play_rad)
    sum -=
        std::sqrt(2.0 * robot.leg.rotor_inertia_kg_m2 / (robot.joint_give_relative * robot.joint_play_rad)) *
        s.play_radps * s.play_radps;
  return sum;
}

TEST(Plant, EnergyChangesByTheWorkOfEveryForce) {
  for (const auto& [compliance_m_per_N, play_rad] :
       {std::pair{0.0, 0.0}, std::pair{2e-5, 0.0}, std::pair{0.0, 5e-3}, std::pair{2e-5, 5e-3}}) {
    WorldConfig config;
    config.robot.series_compliance_m_per_N = compliance_m_per_N;
    config.robot.joint_play_rad = play_rad;
    Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m));
    plant.place({.foot_z_m = 0.03, .angle_rad = plant.leg().angle_at_length(0.30)});
    NominalController controller(config.controller, 375.0);
    const double start_J = energy_J(plant, config.robot);
    double work_J = 0.0, lost_in_bed_J = 0.0;
    constexpr int kSteps = 40;  // per cycle
    constexpr double kStep_s = 1e-3 / kSteps;
    for (int ms = 0; ms < 500; ++ms) {
      const auto& s = plant.state();
      const double torque_Nm = controller.step(plant.leg(), {s.foot_z_m, s.rotor_rad(), s.rotor_radps()});
      for (int i = 0; i < kSteps; ++i) {
        const double before_W = power_W(plant, config.robot, torque_Nm);
        plant.step(torque_Nm, kStep_s);
        work_J += 0.5 * kStep_s * (before_W + power_W(plant, config.robot, torque_Nm));
        lost_in_bed_J -= kStep_s * plant.motion(torque_Nm).contact_force_N * plant.state().foot_velocity_mps;
      }
    }
    const double end_J = energy_J(plant, config.robot);
    std::printf(
        "compliance %g m/N, play %g rad: energy %.4f -> %.4f J, work %.4f J, lost in the bed %.3f J, "
        "mismatch %.1e J\n",
        compliance_m_per_N, play_rad, start_J, end_J, work_J, lost_in_bed_J, end_J - start_J - work_J);
    EXPECT_NEAR(end_J - start_J, work_J, 2e-3);  // error of this sum, not of the plant's integration
    EXPECT_GT(lost_in_bed_J, 0.5);
  }
}

TEST(Plant, AStiffSpringAndLittlePlayAreNone) {
  const auto deepest_m = [](double compliance_m_per_N, double play_rad) {
    WorldConfig config;
    config.robot.series_compliance_m_per_N = compliance_m_per_N;
    config.robot.joint_play_rad = play_rad;
    Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m));
    plant.place({.foot_z_m = 0.02, .angle_rad = plant.leg().angle_at_length(0.30)});
    for (int i = 0; i < 1200; ++i) plant.advance(-0.8, 2.5e-4);
    return plant.max_depth_m();
  };
  const double rigid_m = deepest_m(0.0, 0.0);
  EXPECT_NEAR(deepest_m(1e-7, 0.0), rigid_m, 1e-5);
  EXPECT_NEAR(deepest_m(0.0, 1e-5), rigid_m, 1e-5);
  EXPECT_GT(std::abs(deepest_m(1e-4, 0.0) - rigid_m), 1e-4);
}

TEST(Plant, TheSpringAtTheFootCarriesTheLegAtRest) {
  WorldConfig config = frictionless();
  config.terrain.rigid = true;
  config.robot.series_compliance_m_per_N = 5e-5;
  Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m));
  const double angle_rad = plant.leg().angle_at_length(0.30);
  plant.place({.foot_z_m = 0.005, .angle_rad = angle_rad});
  for (int i = 0; i < 30000; ++i)
    plant.step(60.0 * (angle_rad - plant.state().angle_rad) - 0.6 * plant.state().angular_velocity_radps);
  const double carried_kg = plant.leg().total_mass_kg() - config.robot.leg.foot_mass_kg;
  EXPECT_NEAR(plant.state().series_m, 5e-5 * carried_kg * kGravity_mps2, 1e-6);
}

TEST(Plant, MomentumChangesByWeightContactAndRail) {
  const WorldConfig config = frictionless();
  Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m));
  plant.place({.foot_z_m = 0.01, .angle_rad = 0.9});
  const auto momentum = [&] {
    const auto d = plant.leg().dynamics(plant.state().angle_rad);
    return d.m11_kg * plant.state().foot_velocity_mps + d.m12_kg_m * plant.state().angular_velocity_radps;
  };
  for (int i = 0; i < 2000; ++i) plant.step(-1.5);
  EXPECT_NEAR(momentum(), plant.contact_impulse_Ns() - plant.leg().total_mass_kg() * 9.81 * 0.2, 1e-5);
  EXPECT_GT(plant.contact_impulse_Ns(), 0.5);
}

// A stiff leg throws the foot out of a crater of 30 mm. Without memory the bed's surface has closed again.
// With memory the foot falls to the crater's floor, then follows the unloading line and the virgin bed.
TEST(Plant, LaterStrideLandsOnTheCraterFloor) {
  const WorldConfig config;
  for (const bool memory : {true, false}) {
    Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m), {.bed_memory = memory});
    const double angle_rad = plant.leg().angle_at_length(0.30);
    const double crater_m = 0.03;
    plant.place({.foot_z_m = -crater_m, .foot_velocity_mps = 1.0, .angle_rad = angle_rad});
    double first_force_depth_m = 0.0;
    bool falling = false;
    for (int i = 0; i < 10000; ++i) {
      plant.step(200.0 * (angle_rad - plant.state().angle_rad) - 3.0 * plant.state().angular_velocity_radps);
      falling = falling || (plant.state().foot_z_m > 0.0 && plant.state().foot_velocity_mps < 0.0);
      if (falling && first_force_depth_m == 0.0 && plant.motion(0.0).contact_force_N > 0.0)
        first_force_depth_m = -plant.state().foot_z_m;
    }
    ASSERT_TRUE(falling);
    EXPECT_NEAR(first_force_depth_m, memory ? plant.bed().crater_floor_m(crater_m) : 0.0, 2e-4);
    EXPECT_NEAR(-plant.state().foot_z_m, plant.bed().crater_floor_m(plant.max_depth_m()), 2e-3);
    EXPECT_LT(std::abs(plant.state().foot_velocity_mps), 1e-3);
  }
}

TEST(Plant, RigidGroundHoldsTheFootAndCarriesTheWeight) {
  WorldConfig config;
  config.terrain.rigid = true;
  Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m));
  const double angle_rad = plant.leg().angle_at_length(0.30);
  plant.place({.foot_z_m = 0.02, .angle_rad = angle_rad});
  const auto leg_spring = [&] {
    return 60.0 * (angle_rad - plant.state().angle_rad) - 0.6 * plant.state().angular_velocity_radps;
  };
  for (int i = 0; i < 20000; ++i) plant.step(leg_spring());
  EXPECT_EQ(plant.state().foot_z_m, 0.0);
  EXPECT_EQ(plant.state().foot_velocity_mps, 0.0);
  EXPECT_NEAR(plant.motion(leg_spring()).contact_force_N, plant.leg().total_mass_kg() * 9.81, 1e-2);
  EXPECT_NEAR(plant.contact_impulse_Ns() / 2.0, plant.leg().total_mass_kg() * 9.81,
              2.0);  // mean over the 2 s

  // makes the foot leave the ground
  for (int i = 0; i < 2000 && plant.state().foot_z_m == 0.0; ++i) plant.step(-5.0);
  EXPECT_GT(plant.state().foot_z_m, 0.0);
  EXPECT_EQ(plant.motion(0.0).contact_force_N, 0.0);
}

// Dry friction c tanh(v / v_s): most of it above v_s, little below; v_s is a key.
TEST(Plant, DryFrictionChangesItsSignWithinTheStatedSpeeds) {
  WorldConfig config = frictionless();
  config.robot.rail_coulomb_N = 4.0;
  config.robot.joint_coulomb_Nm = 0.1;
  const auto at = [&](double speed_mps, double rate_radps) {
    Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m));
    const double lift = plant.leg().kinematics(1.0).dlength_m_per_rad * rate_radps;
    plant.place({.foot_z_m = 0.1,
                 .foot_velocity_mps = speed_mps - lift,
                 .angle_rad = 1.0,
                 .angular_velocity_radps = rate_radps});
    return plant.motion(0.0);
  };
  EXPECT_NEAR(at(0.01, 0.0).rail_force_N, -4.0 * std::tanh(1.0), 1e-9);
  EXPECT_NEAR(at(0.0, 0.2).joint_torque_Nm, -2.0 * 0.1 * std::tanh(1.0), 1e-9);
  config.robot.rail_friction_switch_speed_mps = 0.1;
  config.robot.joint_friction_switch_speed_radps = 2.0;
  EXPECT_NEAR(at(0.01, 0.0).rail_force_N, -4.0 * std::tanh(0.1), 1e-9);
  EXPECT_NEAR(at(0.0, 0.2).joint_torque_Nm, -2.0 * 0.1 * std::tanh(0.1), 1e-9);
}

TEST(WorldConfig, EveryKeyOfTheFormatIsReadAndAnUnknownOneIsNot) {
  const auto config = load_text<WorldConfig>("nominal.toml", R"(
gravity_mps2 = 9.81
[robot]
body_mass_kg = 1.7
hip_offset_m = 0.01
rail_coulomb_N = 3.0
rail_viscous_N_s_per_m = 0.1
joint_coulomb_Nm = 0.01
rail_friction_switch_speed_mps = 0.02
joint_friction_switch_speed_radps = 0.1
cogging_amplitude_Nm = 0.03
cogging_periods_per_rev = 252
[motor]
torque_constant_Nm_per_A = 0.0752
torque_limit_Nm = 2.8
current_loop_time_constant_s = 0.0005
[controller]
rate_Hz = 1000
touchdown_deflection_m = 0.002
[terrain]
stiffness_N_per_m = 1200
rigid = true
[sensors]
imu_noise_mps2 = 0.02
[spread]
bed_stiffness_relative = 0.05
)",
                                             MissingKeys::use_default);
  EXPECT_EQ(config.robot.leg.body_mass_kg, 1.7);
  EXPECT_EQ(config.robot.rail_coulomb_N, 3.0);
  EXPECT_EQ(config.robot.rail_friction_switch_speed_mps, 0.02);
  EXPECT_EQ(config.robot.joint_friction_switch_speed_radps, 0.1);
  EXPECT_EQ(config.motor.torque_constant_Nm_per_A, 0.0752);
  EXPECT_EQ(config.terrain.stiffness_N_per_m, 1200.0);
  EXPECT_TRUE(config.terrain.rigid);
  EXPECT_EQ(config.spread.bed_stiffness_relative, 0.05);
  EXPECT_THROW(load_text<WorldConfig>("nominal.toml", "[terrain]\nstiffnes_N_per_m = 1200\n",
                                      MissingKeys::use_default),
               ConfigError);
}

// The foot is dropped, pressed down and pushed off again: the bed yields, unloads, yields again, and the foot
// leaves.
template <class Step>
PlantState pushed_off(double release_height_m, double step_s, Step&& step) {
  const WorldConfig config;
  Plant plant(config, Bed(config.terrain, config.robot.leg.foot_radius_m));
  plant.place({.foot_z_m = release_height_m, .angle_rad = plant.leg().angle_at_length(0.30)});
  const auto count = std::lround(0.3 / step_s);
  for (long i = 0; i < count; ++i) {
    const double time_s = step_s * (static_cast<double>(i) + 0.5);
    step(plant, time_s < 0.18 ? -0.8 : -2.0);
  }
  return plant.state();
}

TEST(Plant, CoarseStepsEndWhereFineOnesDo) {
  const auto fine =
      pushed_off(0.02, Plant::kStep_s, [](Plant& plant, double torque_Nm) { plant.step(torque_Nm); });
  const auto coarse =
      pushed_off(0.02, 2.5e-4, [](Plant& plant, double torque_Nm) { plant.advance(torque_Nm, 2.5e-4); });
  std::printf("foot %.4f mm and %.4f mm, %.4f m/s and %.4f m/s\n", 1e3 * fine.foot_z_m, 1e3 * coarse.foot_z_m,
              fine.foot_velocity_mps, coarse.foot_velocity_mps);
  EXPECT_NEAR(coarse.foot_z_m, fine.foot_z_m, 5e-5);
  EXPECT_NEAR(coarse.foot_velocity_mps, fine.foot_velocity_mps, 2e-3);
}

// A fit needs derivatives. So the final state must not jump when the instant at which the bed yields crosses
// a step.
TEST(Plant, TheEndOfCoarseStepsIsSmoothInTheStart) {
  const auto end = [](double height_m) {
    return pushed_off(height_m, 2.5e-4,
                      [](Plant& plant, double torque_Nm) { plant.advance(torque_Nm, 2.5e-4); })
        .foot_z_m;
  };
  constexpr double kShift_m = 2e-5;
  double roughest_m = 0.0, slope = 0.0;
  for (int i = 1; i < 60; ++i) {
    const double at = 0.02 + kShift_m * i;
    slope = std::max(slope, std::abs(end(at + kShift_m) - end(at - kShift_m)));
    roughest_m = std::max(roughest_m, std::abs(end(at + kShift_m) - 2.0 * end(at) + end(at - kShift_m)));
  }
  std::printf("moves by %.2e m, second difference %.2e m at the most\n", slope, roughest_m);
  EXPECT_LT(roughest_m, 0.05 * slope);
}

TEST(WorldConfig, ALegThatLocksOrCannotReachIsRefused) {
  EXPECT_THROW(load_text<WorldConfig>("nominal.toml", "[robot]\nlower_link_length_m = 0.1\n",
                                      MissingKeys::use_default),
               ConfigError);
  EXPECT_THROW(load_text<WorldConfig>("nominal.toml", "[controller]\nextension_length_m = 0.4\n",
                                      MissingKeys::use_default),
               ConfigError);
}

}  // namespace
}  // namespace sandhopper
