#include "tools/diagnose/plants/rotary_axis/rotary_simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/model/edits.hpp"

namespace sandhopper::diagnose {
namespace {

struct Swing {
  Signal position, velocity;
};

// 20 s of a released arm on a grid of `step_s`; its laws are drag and a cogging of twelve periods a turn.
Swing swing(double step_s, bool is_driven, double coulomb_Nm, double speed_radps = 0.0) {
  Belief belief;
  belief.numbers = {{"axis.inertia_kg_m2", 0.02},
                    {"axis.gravity_torque_Nm", 0.5},
                    {"axis.coulomb_friction_Nm", coulomb_Nm},
                    {"axis.friction_switch_speed_radps", 0.01}};
  const RotaryFigures figures(belief, {});
  const Law laws_of_axis = [](const PortState& port) {
    const auto& s = std::get<AxisState>(port);
    return -2e-3 * s.velocity_radps * std::abs(s.velocity_radps) + 5e-3 * std::sin(12.0 * s.angle_rad);
  };
  const std::vector<const Law*> laws{&laws_of_axis};
  const auto count = static_cast<std::size_t>(std::lround(20.0 / step_s)) + 3;
  const Signal torque{0.0, step_s, std::vector<double>(count, 0.0)};
  Swing out{{0.0, step_s, {}}, {0.0, step_s, {}}};
  simulate_axis(figures, laws, {torque, torque, is_driven}, {0.0, 20.0, 1.2, speed_radps}, 0.008,
                out.position, out.velocity);
  return out;
}

double farthest(const Signal& a, const Signal& b) {
  double most = 0.0;
  for (double t = 0.1; t < 19.9; t += 0.035)  // times on both grids
    most = std::max(most, std::abs(a.at(t) - b.at(t)));
  return most;
}

TEST(RotarySimulation, FreeAxisMovesAsInTenTimesFinerStepsOfADrivenOne) {
  for (const double coulomb_Nm : {0.0, 0.01, 0.05}) {  // the last one comes to rest
    const Swing fine = swing(5e-4, true, coulomb_Nm), free = swing(5e-3, false, coulomb_Nm);
    EXPECT_LT(farthest(fine.position, free.position), 5e-5) << coulomb_Nm;
    EXPECT_LT(farthest(fine.velocity, free.velocity), 5e-4) << coulomb_Nm;
  }
}

TEST(RotarySimulation, FreeAxisThatTurnsOverAndOverIsNoLessExact) {
  const Swing fine = swing(5e-4, true, 0.0, 60.0), free = swing(5e-3, false, 0.0, 60.0);
  EXPECT_LT(farthest(fine.position, free.position), 2e-3);  // of more than 200 rad
}

TEST(RotarySimulation, FreeAxisWithFrictionTooStiffForItsStepsStaysAtRest) {
  const Swing free = swing(5e-3, false, 5.0);
  for (const double w : free.velocity.values) EXPECT_LT(std::abs(w), 1.0);
  EXPECT_TRUE(std::isfinite(free.position.values.back()));
}

}  // namespace
}  // namespace sandhopper::diagnose
