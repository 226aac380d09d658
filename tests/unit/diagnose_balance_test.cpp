#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/balance.hpp"
#include "tools/diagnose/plants/hopper_balance.hpp"
#include "tools/diagnose/plants/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper_simulation.hpp"
#include "tools/diagnose/plants/rotary_balance.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::diagnose {
namespace {

// A hop with something at a port, as both accelerometers, encoder, current, load cell and height sensor would
// record it.
Trial hop(const Belief& belief, double release_m, const Edits& edits, std::uint64_t seed) {
  HopperRun run;
  run.world = world_of(belief, edits);
  const Leg leg(run.world.robot.leg);
  run.start.foot_z_m = release_m;
  run.start.angle_rad = leg.angle_at_length(run.world.controller.compression_length_m);
  run.to_s = 0.6;
  const auto traces = simulate_hopper(run, edits);
  Random random(seed, 0);
  Trial trial;
  trial.kind = "hop";
  trial.setup["release_height_m"] = release_m;
  for (std::size_t i = 0; i < 600; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    trial.time_s.push_back(t);
    const auto put = [&](const char* channel, double value, double noise) {
      trial.channels[channel].push_back(value + noise * random.normal());
    };
    const double g = run.world.gravity_mps2;
    const double current_A = traces.current_torque_Nm.at(t) / run.world.robot.leg.motor_count /
                             run.world.motor.torque_constant_Nm_per_A;
    put("imu_body_accel_z_mps2", traces.body_accel_mps2.at(t) + g, 0.05);
    put("imu_foot_accel_z_mps2", traces.foot_accel_mps2.at(t) + g, 0.05);
    for (const char* motor : {"motor_left_", "motor_right_"}) {
      put((std::string(motor) + "position_rad").c_str(), traces.angle_rad.at(t), 2e-4);
      put((std::string(motor) + "current_A").c_str(), current_A, 0.05);
    }
    put("load_cell_force_N", traces.force_N.at(t), 0.1);
    put("tof_height_m", traces.body_z_m.at(t), 2e-3);
  }
  return trial;
}

std::vector<FreeGain> laws_with(const Edits& edits) {
  Problem problem;
  problem.plant = make_plant(PlantKind::hopper);
  problem.context.plant = PlantKind::hopper;
  const Belief belief;
  std::vector<Balance> balances;
  for (std::uint64_t i = 0; i < 6; ++i)
    for (auto& balance : balances_of(hop(belief, 0.03 + 0.01 * static_cast<double>(i), edits, i + 1), belief))
      balances.push_back(std::move(balance));
  return laws_of_balances(problem, balances);
}

double peak_at(const FreeGain& gain) {
  Eigen::Index largest = 0;
  gain.size.cwiseAbs().maxCoeff(&largest);
  return gain.family.knots[static_cast<std::size_t>(largest)];
}

TEST(DiagnoseBalance, ATorqueThatHoldsTheLegAtAnAngleShowsAtTheJointAndThere) {
  Edits edits;
  edits.law("joint",
            [](const PortState& s) { return -0.6 * std::exp(-std::pow((s.position - 1.1) / 0.1, 2)); });
  const auto laws = laws_with(edits);
  ASSERT_FALSE(laws.empty());
  EXPECT_EQ(laws.front().family.port, "joint");
  EXPECT_EQ(laws.front().family.variable, "angle_rad");
  EXPECT_GT(laws.front().held_out, 0.5);
  EXPECT_LT(laws.front().p_value, 1e-3);
  EXPECT_NEAR(peak_at(laws.front()), 1.1, 0.1);
}

TEST(DiagnoseBalance, ARoughSpotOfTheRailShowsAtTheRailAndAtItsHeight) {
  Edits edits;
  edits.law("rail", [](const PortState& s) {
    return -6.0 * std::exp(-std::pow((s.position - 0.38) / 0.01, 2)) * std::tanh(s.velocity / 0.01);
  });
  const auto laws = laws_with(edits);
  ASSERT_FALSE(laws.empty());
  EXPECT_EQ(laws.front().family.port, "rail");
  EXPECT_EQ(laws.front().family.variable, "height_m, with the sign of velocity");
  EXPECT_GT(laws.front().held_out, 0.3);
  EXPECT_LT(laws.front().p_value, 1e-2);
  EXPECT_NEAR(peak_at(laws.front()), 0.38, 0.02);
}

TEST(DiagnoseBalance, WhatIsOnTheListOrNotThereIsNoLawOfItsOwn) {
  Edits friction;
  friction.law("rail", [](const PortState& s) { return -2.0 * std::tanh(s.velocity / 0.01); });
  friction.law("joint", [](const PortState& s) { return -0.01 * s.velocity; });
  for (const auto& edits : {Edits{}, friction})
    for (const auto& law : laws_with(edits))
      if (law.family.variable != "t_s" && law.family.variable != "torque_Nm") {
        EXPECT_LT(law.held_out, 0.15) << law.family.port << " " << law.family.variable;
      }
}

TEST(DiagnoseBalance, WithoutAccelerometersThereIsNone) {
  const Belief belief;
  Trial trial = hop(belief, 0.05, {}, 1);
  trial.channels.erase("imu_foot_accel_z_mps2");
  EXPECT_TRUE(balances_of(trial, belief).empty());
}

std::vector<FreeGain> axis_laws_with(const AxisTorque& left_out) {
  const auto recordings = swings(left_out, 2, 6);
  Problem problem;
  problem.plant = make_plant(PlantKind::rotary_axis);
  problem.context.plant = PlantKind::rotary_axis;
  std::vector<Balance> balances;
  for (const auto& trial : recordings.trials)
    for (auto& balance : balances_of_axis(trial, recordings.belief)) balances.push_back(std::move(balance));
  auto laws = laws_of_balances(problem, balances);
  // What the drive's constant would leave is not among the known shapes.
  std::erase_if(laws, [](const FreeGain& law) { return law.family.variable == "torque_Nm"; });
  return laws;
}

TEST(DiagnoseBalance, AnAxisThatRubsInASectorShowsThere) {
  const auto laws = axis_laws_with([](double angle, double speed, double) {
    return angle > 0.1 && angle < 0.3 ? -0.8 * std::tanh(speed / 0.02) : 0.0;
  });
  ASSERT_FALSE(laws.empty());
  EXPECT_EQ(laws.front().family.variable, "position_rad, with the sign of velocity");
  EXPECT_GT(laws.front().held_out, 0.25);
  EXPECT_LT(laws.front().p_value, 1e-2);
  EXPECT_NEAR(peak_at(laws.front()), 0.2, 0.1);
}

TEST(DiagnoseBalance, AnAxisThatAMagnetHoldsShowsItsAngle) {
  const auto laws = axis_laws_with([](double angle, double, double) {
    const double off = (angle - 0.2) / 0.25;
    return -0.8 * off * std::exp(0.5 * (1.0 - off * off));
  });
  ASSERT_FALSE(laws.empty());
  EXPECT_EQ(laws.front().family.variable, "position_rad");
  EXPECT_GT(laws.front().held_out, 0.25);
  EXPECT_LT(laws.front().p_value, 1e-2);
}

TEST(DiagnoseBalance, FrictionAndGravityOfAnAxisAreOnTheList) {
  const AxisTorque friction = [](double, double v, double) { return -0.2 * std::tanh(v / 0.02) - 0.03 * v; };
  const AxisTorque gravity = [](double q, double, double) { return 0.2 * std::cos(q) - 0.4 * std::sin(q); };
  const AxisTorque nothing = [](double, double, double) { return 0.0; };
  for (const auto& listed : {nothing, friction, gravity})
    for (const auto& law : axis_laws_with(listed)) EXPECT_LT(law.held_out, 0.25) << law.family.variable;
}

}  // namespace
}  // namespace sandhopper::diagnose
