#include "firmware/supervision/thermal_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace sandhopper {
namespace {

constexpr double kStep_s = 1e-3;
constexpr double kCurrent_A = 20.0;

struct Temperatures {
  double winding_C, housing_C;
};

double loss_W(const SupervisionConfig& c, double current_A) {
  return 1.5 * c.phase_resistance_Ohm * current_A * current_A;
}

// Solution for two heat capacities in series that start at ambient temperature, with a constant loss in the
// first:
//   x(t) = (1 - exp(A t)) x_end,  exp(A t) = (exp(p t) (A - q) - exp(q t) (A - p)) / (p - q)
// with the eigenvalues p, q of A.
Temperatures closed_form(const SupervisionConfig& c, double loss_W, double time_s) {
  const double rw = c.winding_resistance_K_per_W, rh = c.housing_resistance_K_per_W;
  const double cw = c.winding_capacity_J_per_K, ch = c.housing_capacity_J_per_K;
  const std::array<double, 2> end{loss_W * (rw + rh), loss_W * rh};
  const double a = -1.0 / (cw * rw), b = -a;
  const double d = -(1.0 / rw + 1.0 / rh) / ch, e = 1.0 / (ch * rw);
  const double middle = 0.5 * (a + d), half = std::sqrt(0.25 * (a - d) * (a - d) + b * e);
  const double p = middle + half, q = middle - half;
  const double f = std::exp(p * time_s) / (p - q), g = std::exp(q * time_s) / (p - q);
  const double winding_left = (f * (a - q) - g * (a - p)) * end[0] + (f - g) * b * end[1];
  const double housing_left = (f - g) * e * end[0] + (f * (d - q) - g * (d - p)) * end[1];
  return {c.ambient_C + end[0] - winding_left, c.ambient_C + end[1] - housing_left};
}

ThermalModel after(const SupervisionConfig& c, double current_A, double time_s) {
  ThermalModel model(c);
  for (double t = 0.5 * kStep_s; t < time_s; t += kStep_s) model.step(current_A, kStep_s);
  return model;
}

TEST(ThermalModel, StepOfCurrentHasTheClosedFormsResponse) {
  const SupervisionConfig c;
  for (const double time_s : {1.0, 30.0, 120.0, 600.0}) {
    const auto expected = closed_form(c, loss_W(c, kCurrent_A), time_s);
    const auto model = after(c, kCurrent_A, time_s);
    EXPECT_NEAR(model.winding_C(), expected.winding_C, 0.002) << time_s << " s";
    EXPECT_NEAR(model.housing_C(), expected.housing_C, 0.002) << time_s << " s";
  }
  EXPECT_NEAR(closed_form(c, 37.5, 1e5).winding_C, 25.0 + 37.5 * 3.0, 1e-6);
}

// If the pulse is shorter than the heat transfer to the housing, all heat stays in the winding.
TEST(ThermalModel, AShortPulseHeatsTheWindingAlone) {
  const SupervisionConfig c;
  const auto model = after(c, kCurrent_A, 0.1);
  EXPECT_NEAR(model.winding_C() - c.ambient_C, loss_W(c, kCurrent_A) * 0.1 / c.winding_capacity_J_per_K,
              2e-4);
  EXPECT_NEAR(model.housing_C(), c.ambient_C, 1e-4);
}

TEST(ThermalModel, CoolsTowardsAmbientWhenTheCurrentStops) {
  const SupervisionConfig c;
  auto model = after(c, kCurrent_A, 300.0);
  double last_C = model.winding_C();
  ASSERT_GT(last_C, 60.0);
  for (int minute = 0; minute < 60; ++minute) {
    for (int k = 0; k < 60'000; ++k) model.step(0.0, kStep_s);
    EXPECT_LT(model.winding_C(), last_C);
    last_C = model.winding_C();
  }
  EXPECT_NEAR(last_C, c.ambient_C, 0.1);
}

TEST(ThermalModel, CurrentHeatsInBothDirectionsAlike) {
  const SupervisionConfig c;
  EXPECT_EQ(after(c, -kCurrent_A, 10.0).winding_C(), after(c, kCurrent_A, 10.0).winding_C());
  EXPECT_EQ(after(c, 0.0, 10.0).winding_C(), c.ambient_C);
}

}  // namespace
}  // namespace sandhopper
