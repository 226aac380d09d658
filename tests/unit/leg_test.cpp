#include "estimation/leg.hpp"

#include <gtest/gtest.h>

namespace sandhopper {
namespace {

// Reference figures from a symbolic derivation that is independent of this code. Each is compared to half a
// unit of its last printed digit.
struct Vector {
  double angle, dl, m12, m22, mf, beta, c, dmf, length, dm12, dm22;
};

class LegVectors : public ::testing::TestWithParam<Vector> {};

TEST_P(LegVectors, AgreeWithTheSymbolicDerivationInEveryPrintedDigit) {
  const auto& v = GetParam();
  const auto d = Leg(LegParameters{}).dynamics(v.angle);
  EXPECT_NEAR(d.leg.dlength_m_per_rad, v.dl, 0.5e-6);
  EXPECT_NEAR(d.m12_kg_m, v.m12, 0.5e-6);
  EXPECT_NEAR(d.m22_kg_m2, v.m22, 0.5e-7);
  EXPECT_NEAR(d.reduced_mass_kg, v.mf, 0.5e-6);
  EXPECT_NEAR(d.torque_gain_per_m, v.beta, 0.5e-6);
  EXPECT_NEAR(d.coriolis_N_s2_per_rad2, v.c, 0.5e-6);
  EXPECT_NEAR(d.dreduced_mass_kg_per_rad, v.dmf, 0.5e-6);
  EXPECT_NEAR(d.leg.length_m, v.length, 0.5e-6);
  EXPECT_NEAR(d.dm12_kg_m_per_rad, v.dm12, 0.5e-7);
  EXPECT_NEAR(d.dm22_kg_m2_per_rad, v.dm22, 0.5e-8);
}

INSTANTIATE_TEST_SUITE_P(DefaultRobot, LegVectors,
                         ::testing::Values(Vector{0.8, -.118207, -.197934, .0238305, .685983, -8.305905,
                                                  -.007363, -.122305, .307636, -.1426975, .03258767},
                                           Vector{1.2, -.134748, -.224395, .0303041, .668408, -7.404772,
                                                  .000914, .013537, .255829, .0109646, -.00271461},
                                           Vector{1.6, -.117927, -.194398, .0231074, .694578, -8.412773,
                                                  .007531, .126714, .204372, .1260754, -.02818199}));

TEST(Leg, HipOffsetVectorAgrees) {
  LegParameters p;
  p.hip_offset_m = 0.045;
  const auto d = Leg(p).dynamics(1.2);
  EXPECT_NEAR(d.leg.length_m, .2251412, 0.5e-7);
  EXPECT_NEAR(d.leg.dlength_m_per_rad, -.1493881, 0.5e-7);
  EXPECT_NEAR(d.m12_kg_m, -.2498692, 0.5e-7);
  EXPECT_NEAR(d.m22_kg_m2, .0372357, 0.5e-7);
  EXPECT_NEAR(d.reduced_mass_kg, .6532604, 0.5e-7);
  EXPECT_NEAR(d.torque_gain_per_m, -6.7104687, 0.5e-7);
  EXPECT_NEAR(d.coriolis_N_s2_per_rad2, .0028977, 0.5e-7);
}

TEST(Leg, DerivativesAreThoseOfTheFunctions) {
  LegParameters p;
  p.hip_offset_m = 0.03;
  p.upper_link_com_m = 0.05;
  const Leg leg(p);
  const double h = 1e-5;
  for (double a = 0.3; a < 2.5; a += 0.1) {
    const auto lo = leg.dynamics(a - h);
    const auto hi = leg.dynamics(a + h);
    const auto d = leg.dynamics(a);
    const auto slope = [&](double low, double high) { return (high - low) / (2 * h); };
    EXPECT_NEAR(d.leg.dlength_m_per_rad, slope(lo.leg.length_m, hi.leg.length_m), 1e-9);
    EXPECT_NEAR(d.leg.d2length_m_per_rad2, slope(lo.leg.dlength_m_per_rad, hi.leg.dlength_m_per_rad), 1e-9);
    EXPECT_NEAR(d.dm12_kg_m_per_rad, slope(lo.m12_kg_m, hi.m12_kg_m), 1e-9);
    EXPECT_NEAR(d.dm22_kg_m2_per_rad, slope(lo.m22_kg_m2, hi.m22_kg_m2), 1e-9);
    EXPECT_NEAR(d.dreduced_mass_kg_per_rad, slope(lo.reduced_mass_kg, hi.reduced_mass_kg), 1e-8);
  }
}

TEST(Leg, AngleAtLengthInvertsTheLength) {
  const Leg leg(LegParameters{});
  for (double a = 0.2; a < 2.6; a += 0.05)
    EXPECT_NEAR(leg.angle_at_length(leg.kinematics(a).length_m), a, 1e-12);
}

TEST(Leg, OneGearedMotorReflectsItsRotorBySquareOfTheRatio) {
  LegParameters two;
  LegParameters one = two;
  one.motor_count = 1;
  one.gear_ratio = 6.0;
  const double expected = 36.0 * one.rotor_inertia_kg_m2 - 2.0 * two.rotor_inertia_kg_m2;
  EXPECT_NEAR(Leg(one).dynamics(1.0).m22_kg_m2 - Leg(two).dynamics(1.0).m22_kg_m2, expected, 1e-15);
}

TEST(Leg, MasslessLegLeavesTheFootsOwnWeight) {
  LegParameters p;
  p.upper_link_mass_kg = p.lower_link_mass_kg = 0.0;
  p.upper_link_inertia_kg_m2 = p.lower_link_inertia_kg_m2 = p.rotor_inertia_kg_m2 = 0.0;
  const auto d = Leg(p).dynamics(1.1);
  EXPECT_NEAR(d.reduced_mass_kg, p.foot_mass_kg, 1e-14);
  EXPECT_NEAR(d.torque_gain_per_m, 1.0 / d.leg.dlength_m_per_rad, 1e-12);
  EXPECT_NEAR(d.coriolis_N_s2_per_rad2, 0.0, 1e-14);
}

TEST(Leg, GeometryThatLocksIsRefused) {
  LegParameters p;
  p.lower_link_length_m = p.upper_link_length_m;
  EXPECT_THROW(Leg{p}, std::invalid_argument);
}

// Flight with a torsion spring, RK4 at 0.1 ms for 0.4 s. The integrator's error is so small that a missing
// term of the equations shows.
TEST(Leg, EnergyIsKeptInFlight) {
  const Leg leg(LegParameters{});
  const double k_spring = 2.0;
  struct S {
    double x, v, a, w;
  };
  const auto rhs = [&](const S& s) {
    const auto d = leg.dynamics(s.a);
    const double tau = -k_spring * (s.a - 0.9);
    const double xdd =
        (-d.torque_gain_per_m * tau - d.coriolis_N_s2_per_rad2 * s.w * s.w) / d.reduced_mass_kg -
        kGravity_mps2;
    const double gravity = d.m12_kg_m * kGravity_mps2;
    const double add =
        (tau - d.m12_kg_m * xdd - d.dm22_kg_m2_per_rad * s.w * s.w / 2 - gravity) / d.m22_kg_m2;
    return S{s.v, xdd, s.w, add};
  };
  const auto plus = [](const S& s, const S& d, double h) {
    return S{s.x + h * d.x, s.v + h * d.v, s.a + h * d.a, s.w + h * d.w};
  };
  const auto energy = [&](const S& s) {
    return mechanical_energy_J(leg, s.x, s.v, s.a, s.w) + k_spring * (s.a - 0.9) * (s.a - 0.9) / 2;
  };
  S s{0.5, 0.3, 1.2, 2.0};
  const double e0 = energy(s);
  const double h = 1e-4;
  for (int i = 0; i < 4000; ++i) {
    const S k1 = rhs(s), k2 = rhs(plus(s, k1, h / 2)), k3 = rhs(plus(s, k2, h / 2)), k4 = rhs(plus(s, k3, h));
    s = plus(plus(plus(plus(s, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
  }
  const double drift = std::abs(energy(s) - e0) / std::abs(e0);
  RecordProperty("relative_energy_drift", std::to_string(drift));
  printf("energy drift over 0.4 s of flight: %.2e relative\n", drift);
  EXPECT_LE(drift, 1e-12);
}

}  // namespace
}  // namespace sandhopper
