#include "estimation/joint_force.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "estimation/local_polynomial.hpp"

namespace sandhopper {
namespace {

// A leg that stands on rigid ground and moves by the second row of its equation of motion.
struct Standing {
  double accel_radps2;
  double force_N;
};
Standing standing(const Leg& leg, double angle_rad, double rate_radps, double torque_Nm) {
  const auto d = leg.dynamics(angle_rad);
  const double square = rate_radps * rate_radps;
  const double accel =
      (torque_Nm - d.m12_kg_m * kGravity_mps2 - d.dm22_kg_m2_per_rad / 2.0 * square) / d.m22_kg_m2;
  return {accel, d.m12_kg_m * accel + d.dm12_kg_m_per_rad * square + d.m11_kg * kGravity_mps2};
}

TEST(JointForce, BothRowsGiveTheForceOfTheEquationOfMotion) {
  const Leg leg{LegParameters{}};
  for (const double angle : {0.6, 1.2, 1.9})
    for (const double rate : {-12.0, 0.0, 9.0}) {
      const auto truth = standing(leg, angle, rate, -3.0);
      const JointState state{angle, rate, truth.accel_radps2};
      EXPECT_NEAR(joint_row_force_N(leg, state, -3.0), truth.force_N, 1e-9);
      EXPECT_NEAR(reduced_row_force_N(leg, state, -3.0), truth.force_N, 1e-9);
    }
}

TEST(JointForce, JointRowDoesNotKnowTheBodysMass) {
  LegParameters light{}, heavy{};
  heavy.body_mass_kg = 3.0 * light.body_mass_kg;
  const JointState state{1.1, 7.0, -150.0};
  EXPECT_NEAR(joint_row_force_N(Leg{light}, state, -4.0), joint_row_force_N(Leg{heavy}, state, -4.0), 1e-9);
}

TEST(JointForce, MasslessLegIsQuasiStatic) {
  LegParameters p{};
  p.foot_mass_kg = p.upper_link_mass_kg = p.lower_link_mass_kg = 0.0;
  p.upper_link_inertia_kg_m2 = p.lower_link_inertia_kg_m2 = p.rotor_inertia_kg_m2 = 0.0;
  const Leg leg{p};
  const double dl = leg.kinematics(1.0).dlength_m_per_rad;
  EXPECT_NEAR(joint_row_force_N(leg, {1.0, 8.0, -200.0}, -2.0), -2.0 / dl, 1e-9);
}

TEST(JointForce, ObserverSettlesOnTheForceWithItsOwnDelay) {
  const Leg leg{LegParameters{}};
  constexpr double kGain_per_s = 200.0, kStep_s = 1e-4;
  double angle = 0.8, rate = 6.0, delayed = 0.0, worst_N = 0.0;
  JointRowObserver observer(kGain_per_s);
  observer.reset(leg, angle, rate);
  for (int i = 0; i < 2000; ++i) {
    const double torque = -3.0 - 2.0 * std::sin(60.0 * i * kStep_s);
    const auto now = standing(leg, angle, rate, torque);
    rate += now.accel_radps2 * kStep_s;
    angle += rate * kStep_s;
    const double estimate = observer.update(leg, angle, rate, torque, kStep_s);
    delayed += kGain_per_s * kStep_s * (now.force_N - delayed);
    if (i > 500) worst_N = std::max(worst_N, std::abs(estimate - delayed));
  }
  EXPECT_LT(worst_N, 1.0);   // of 45 N; L' changes within the delay
  EXPECT_GT(worst_N, 1e-3);  // the observer is a first-order lag and must not equal the force
}

TEST(JointForce, FrictionOpposesTheMotion) {
  const JointFriction friction{.coulomb_Nm = 0.2, .viscous_Nm_s = 0.01, .switch_radps = 0.1};
  EXPECT_NEAR(friction.torque_Nm(5.0), -0.25, 1e-9);
  EXPECT_NEAR(friction.torque_Nm(-5.0), 0.25, 1e-9);
  EXPECT_EQ(friction.torque_Nm(0.0), 0.0);
}

TEST(LocalPolynomial, DerivativesOfACubicAreExactAtIrregularTimes) {
  std::vector<double> t, x;
  for (int i = 0; i < 200; ++i) {
    t.push_back(1e-3 * i + 2e-4 * std::sin(7.0 * i));
    x.push_back(1.0 + 2.0 * t.back() - 30.0 * t.back() * t.back() + 40.0 * std::pow(t.back(), 3));
  }
  const auto fit = local_polynomial(t, x, 0.012);
  for (const std::size_t i : {0u, 50u, 199u}) {
    EXPECT_NEAR(fit[i].value, x[i], 1e-9);
    EXPECT_NEAR(fit[i].rate, 2.0 - 60.0 * t[i] + 120.0 * t[i] * t[i], 1e-6);
    EXPECT_NEAR(fit[i].acceleration, -60.0 + 240.0 * t[i], 1e-3);
  }
}

TEST(LocalPolynomial, GapLowersTheDegreeInsteadOfBlowingUp) {
  const std::vector<double> t{0.0, 0.001, 0.002, 0.5, 0.501};
  const std::vector<double> x{0.0, 0.01, std::nan(""), 1.0, 1.01};
  const auto fit = local_polynomial(t, x, 0.01);
  EXPECT_NEAR(fit[0].rate, 10.0, 1e-9);
  EXPECT_EQ(fit[0].acceleration, 0.0);
  EXPECT_TRUE(std::isnan(fit[2].value));
  EXPECT_NEAR(fit[4].rate, 10.0, 1e-9);
}

}  // namespace
}  // namespace sandhopper
