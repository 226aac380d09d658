#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/diagnose_campaigns.hpp"

// Further forms of effects of an axis and of its sensors.
namespace sandhopper::diagnose {
namespace {

double value_of(const FoundEffect& effect, const std::string& name) {
  const auto it = std::ranges::find(effect.parameters, name, &FoundParameter::name);
  return it == effect.parameters.end() ? std::nan("") : it->value;
}

// The motor leads the load by `compliance` times its torque. The position shows this, and so does the
// velocity if it is the motor's.
Recordings twisted(bool velocity_of_motor) {
  constexpr double kCompliance_rad_per_Nm = 0.005;
  auto recordings = swings([](double, double, double) { return 0.0; }, 51, 8);
  for (auto& trial : recordings.trials) {
    const auto& torque = trial.channels["torque_Nm"];
    auto &position = trial.channels["position_rad"], &velocity = trial.channels["velocity_radps"];
    for (std::size_t i = 0; i < torque.size(); ++i) {
      position[i] += kCompliance_rad_per_Nm * torque[i];
      if (!velocity_of_motor || i == 0 || i + 1 == torque.size()) continue;
      velocity[i] += kCompliance_rad_per_Nm * (torque[i + 1] - torque[i - 1]) /
                     (trial.time_s[i + 1] - trial.time_s[i - 1]);
    }
  }
  return recordings;
}

TEST(DiagnoseAxisForms, AShaftThatTwistsIsACompliance) {
  for (const bool of_motor : {false, true}) {
    const auto d = diagnose(twisted(of_motor));
    ASSERT_EQ(d.effects.size(), 1u) << of_motor;
    EXPECT_EQ(d.effects.front().id, "rig.compliance");
    EXPECT_NEAR(value_of(d.effects.front(), "compliance_rad_per_Nm"), 0.005, 2e-4);
    EXPECT_NEAR(value_of(d.effects.front(), "velocity_on_motor_side"), of_motor ? 1.0 : 0.0, 0.15);
  }
}

// An accelerometer in a fall through air with two equal lags in series, 30 ms together.
TEST(DiagnoseAxisForms, ALagMayBeOfSecondOrder) {
  const auto drag = [](double, double, double v) { return -0.5 * 1.2 * 0.01 * 3.0 * std::abs(v) * v; };
  auto recordings = drops(drag, 53, 10);
  recordings.belief.numbers["medium.drag_coefficient"] = 3.0;
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  for (auto& trial : recordings.trials) {
    double once = 0.0, twice = 0.0;
    auto& accel = trial.channels["accel_mps2"];
    for (std::size_t i = 0; i < accel.size(); ++i) {
      const double share = 1.0 - std::exp(-5e-3 / 15e-3);
      once += share * (accel[i] - once);
      twice += share * (once - twice);
      accel[i] = twice + 0.05 * std::sin(1e6 * static_cast<double>(i * i));
    }
  }
  const auto d = diagnose(recordings);
  ASSERT_FALSE(d.effects.empty());
  EXPECT_EQ(d.effects.front().id, "imu.lag");
  EXPECT_NEAR(value_of(d.effects.front(), "lag_s"), 0.03, 0.006);
}

// The limit acts before the noise, so no two samples at it are equal.
TEST(DiagnoseAxisForms, ASensorMayStopAtALimitUnderItsNoise) {
  const auto drag = [](double, double, double v) { return -0.5 * 1.2 * 0.01 * 3.0 * std::abs(v) * v; };
  auto recordings = drops(drag, 54, 10);
  recordings.belief.numbers["medium.drag_coefficient"] = 3.0;
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  for (auto& trial : recordings.trials)
    for (double& a : trial.channels["accel_mps2"])
      if (a > 3.0) a = 3.0 + 0.05 * std::sin(1e6 * a * a);
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "sensor.saturation");
  EXPECT_NEAR(value_of(d.effects.front(), "limit_mps2"), 3.0, 0.05);
}

}  // namespace
}  // namespace sandhopper::diagnose
