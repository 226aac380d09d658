#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/discrepancy/balance.hpp"
#include "tools/diagnose/plants/hopper/hopper_balance.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_balance.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<FreeGain> laws_with(const Edits& edits) {
  Problem problem;
  problem.plant = make_plant(PlantKind::hopper);
  problem.context.plant = PlantKind::hopper;
  const Belief belief;
  std::vector<Balance> balances;
  for (std::uint64_t i = 0; i < 6; ++i) {
    const HopperRun run = hop_from(0.03 + 0.01 * static_cast<double>(i), 0.6, edits);
    for (auto& balance : balances_of(recorded(run, edits, i + 1), belief))
      balances.push_back(std::move(balance));
  }
  return laws_of_balances(problem, balances);
}

double peak_at(const FreeGain& gain) {
  Eigen::Index largest = 0;
  gain.size.cwiseAbs().maxCoeff(&largest);
  return gain.family.knots[static_cast<std::size_t>(largest)];
}

TEST(DiagnoseBalance, ATorqueThatHoldsTheLegAtAnAngleShowsAtTheJointAndThere) {
  Edits edits;
  edits.law(LawPort::joint,
            [](const AxisState& s) { return -0.6 * std::exp(-std::pow((s.angle_rad - 1.1) / 0.1, 2)); });
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
  edits.law(LawPort::rail, [](const RailState& s) {
    return -6.0 * std::exp(-std::pow((s.height_m - 0.38) / 0.01, 2)) * std::tanh(s.velocity_mps / 0.01);
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
  friction.law(LawPort::rail, [](const RailState& s) { return -2.0 * std::tanh(s.velocity_mps / 0.01); });
  friction.law(LawPort::joint, [](const AxisState& s) { return -0.01 * s.velocity_radps; });
  Edits heavier;
  heavier.scale("robot.body_mass_kg", 1.1);
  for (const auto& edits : {Edits{}, friction, heavier})
    for (const auto& law : laws_with(edits))
      if (law.family.variable != "t_s" && law.family.variable != "torque_Nm") {
        EXPECT_LT(law.held_out, 0.15) << law.family.port << " " << law.family.variable;
      }
}

TEST(DiagnoseBalance, NothingIsAskedWhereAnAccelerometerClipped) {
  Trial trial = recorded(hop_from(0.05, 0.6), {}, 1);
  const auto whole = balances_of(trial, Belief{});
  auto& foot = trial.channels["imu_foot_accel_z_mps2"];
  double clipped = 0;
  for (std::size_t i = 200; i < 220; ++i, ++clipped) foot[i] = std::numeric_limits<double>::quiet_NaN();
  const auto rest = balances_of(trial, Belief{});
  ASSERT_EQ(whole.size(), rest.size());
  for (std::size_t b = 0; b < whole.size(); ++b) {
    EXPECT_NEAR(static_cast<double>(whole[b].rest.size() - rest[b].rest.size()), clipped, 2.0);
    for (const auto& state : rest[b].states) EXPECT_FALSE(time_of(state) > 0.2005 && time_of(state) < 0.2185);
  }
}

TEST(DiagnoseBalance, WithoutAccelerometersThereIsNone) {
  const Belief belief;
  Trial trial = recorded(hop_from(0.05, 0.6), {}, 1);
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
  // Laws of the torque are left out: they look like a wrong torque constant, which is not among the known
  // shapes.
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

// A spring that yields: after each turning point it gives way by twice its yield angle before it slips.
TEST(DiagnoseBalance, AnAxisOnASpringThatYieldsShowsTheAngleSinceItTurned) {
  constexpr double kYield_rad = 0.1, kStiffness_Nm_per_rad = 5.0;
  double stretch_rad = 0.0, last_rad = 0.0;
  const auto laws = axis_laws_with([=](double angle, double, double) mutable {
    stretch_rad = std::clamp(stretch_rad + angle - last_rad, -kYield_rad, kYield_rad);
    last_rad = angle;
    return -kStiffness_Nm_per_rad * stretch_rad;
  });
  ASSERT_FALSE(laws.empty());
  EXPECT_EQ(laws.front().family.variable, "angle since the last turn, rad, with the sign of velocity");
  EXPECT_GT(laws.front().held_out, 0.25);
  EXPECT_LT(laws.front().p_value, 1e-2);
}

TEST(DiagnoseBalance, AMotionTurnsWhereItComesBackByMoreThanItsNoise) {
  const std::vector<double> angle{0.0, 0.1, 0.2, 0.5, 0.49, 0.51, 0.3, 0.1, -0.2, -0.1, 0.0};
  const std::vector<double> turns{0.0, 0.0, 0.0, 0.0, 0.0, 0.51, 0.51, 0.51, -0.2, -0.2, -0.2};
  const auto found = last_turns(angle, 0.05);
  ASSERT_EQ(found.size(), turns.size());
  for (std::size_t i = 0; i < turns.size(); ++i) EXPECT_DOUBLE_EQ(found[i], turns[i]) << i;
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
