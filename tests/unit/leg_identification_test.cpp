#include "tools/terrain/leg_identification.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sandhopper {
namespace {

struct Truth {
  double scale = 0.95, inertia = 5e-3, coulomb = 0.1, viscous = 0.02, spring = 0.0, offset_s = 0.002;
};

LegParameters massless_leg() {
  LegParameters p{};
  p.body_mass_kg = 1.2;
  p.foot_mass_kg = p.upper_link_mass_kg = p.lower_link_mass_kg = 0.0;
  p.upper_link_inertia_kg_m2 = p.lower_link_inertia_kg_m2 = p.rotor_inertia_kg_m2 = 0.0;
  p.upper_link_length_m = 0.07;
  p.lower_link_length_m = 0.15;
  p.foot_height_m = 0.0;
  return p;
}

// 0.2 s of stance along a given angle, then 0.1 s of flight in which the plate reads its tare. The commanded
// torque is chosen such that the force differs from hop to hop.
LegHop made_hop(const Truth& truth, unsigned seed, bool held_out) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  LegHop hop{.trial = "made", .held_out = held_out, .contact_settling_s = 0.015, .leg = massless_leg()};
  auto with_rotor = hop.leg;
  with_rotor.rotor_inertia_kg_m2 = truth.inertia / with_rotor.motor_count;
  const Leg leg{with_rotor};
  const double phase = 0.3 * normal(rng), amplitude = 0.5 + 0.05 * normal(rng);
  const double w = 31.0 + 5.0 * normal(rng);  // several frequencies: at a single one a spring would look like
                                              // negative inertia
  const auto angle = [&](double t) { return 1.3 - amplitude * std::cos(w * t + phase); };
  const auto rate = [&](double t) { return w * amplitude * std::sin(w * t + phase); };
  const auto accel = [&](double t) { return w * w * amplitude * std::cos(w * t + phase); };
  const auto command = [&](double t) { return -3.0 - 1.5 * std::sin(23.0 * t + 2.0 * phase); };
  const JointFriction friction{truth.coulomb, truth.viscous, 0.2};
  const auto force = [&](double t) {
    const double torque =
        truth.scale * command(t) + friction.torque_Nm(rate(t)) + truth.spring * (1.0 - angle(t));
    return joint_row_force_N(leg, {angle(t), rate(t), accel(t)}, torque);
  };
  for (int i = 0; i < 300; ++i) {
    const double t = 1e-3 * i + 1e-4 * normal(rng);
    hop.t_s.push_back(t);
    hop.angle_rad.push_back(angle(t) + 1e-5 * normal(rng));
    hop.torque_Nm.push_back(command(t));
    hop.stance.push_back(i < 200 ? 1.0 : 0.0);
  }
  for (int i = 0; i < 900; ++i) {
    const double t = i / 3000.0;
    hop.reference_t_s.push_back(t);
    hop.reference_N.push_back(12.0 + (t < 0.203 ? force(t - truth.offset_s) : 0.0) + 0.2 * normal(rng));
  }
  return hop;
}

std::vector<LegHop> made_hops(const Truth& truth) {
  std::vector<LegHop> hops;
  for (unsigned seed = 1; seed <= 8; ++seed) hops.push_back(made_hop(truth, seed, seed > 6));
  return hops;
}

TEST(LegIdentification, FindsTheJointThatMadeTheHops) {
  const Truth truth{};
  const auto leg = identify_leg(made_hops(truth), {});
  EXPECT_NEAR(leg.tare_N, 12.0, 0.1);
  EXPECT_NEAR(leg.value[0], truth.scale, 0.02);
  EXPECT_NEAR(leg.value[1], truth.inertia, 2e-4);
  EXPECT_NEAR(leg.value[2], truth.coulomb, 0.02);
  EXPECT_NEAR(leg.value[3], truth.viscous, 4e-3);
  EXPECT_NEAR(leg.value[4], truth.offset_s, 0.26e-3);
  EXPECT_FALSE(leg.has_spring);
  EXPECT_LT(leg.rms_N(LegForceForm::joint_row_smooth, LegWindow::settled, true), 1.0);
  EXPECT_GT(leg.rms_N(LegForceForm::quasi_static, LegWindow::settled, true), 10.0);
}

TEST(LegIdentification, SpringBesideTheMotorIsTakenInWhenItIsThere) {
  Truth truth{};
  truth.spring = 2.0;
  const auto leg = identify_leg(made_hops(truth), {});
  EXPECT_TRUE(leg.has_spring);
  EXPECT_NEAR(leg.spring_stiffness_Nm_per_rad, 2.0, 0.3);
  EXPECT_NEAR(leg.value[0], truth.scale, 0.05);
  EXPECT_LT(leg.rms_N(LegForceForm::joint_row_smooth, LegWindow::settled, true), 1.2);
}

TEST(LegIdentification, OneHopIsNotEnough) {
  const std::vector hops{made_hop({}, 1, false), made_hop({}, 2, true)};
  EXPECT_THROW(identify_leg(hops, {}), std::invalid_argument);
}

}  // namespace
}  // namespace sandhopper
