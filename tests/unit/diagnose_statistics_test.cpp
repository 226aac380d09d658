#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tools/diagnose/effect.hpp"
#include "tools/diagnose/signal.hpp"
#include "tools/diagnose/statistics.hpp"

namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseStatistics, StudentTailsAreThoseOfTables) {
  EXPECT_NEAR(student_t_two_sided(2.228, 10.0), 0.05, 1e-4);
  EXPECT_NEAR(student_t_two_sided(4.604, 4.0), 0.01, 1e-4);
  EXPECT_NEAR(student_t_quantile(0.05, 10.0), 2.228, 1e-3);
  EXPECT_NEAR(student_t_two_sided(0.0, 3.0), 1.0, 1e-12);
}

TEST(DiagnoseStatistics, TrialsThatDisagreeAreNoEvidence) {
  const TrialEvidence agree{{100, 110, 90, 105, 95, 100}, {100, 100, 100, 100, 100, 100}};
  const TrialEvidence disagree{{100, -110, 90, -105, 95, -60}, {100, 100, 100, 100, 100, 100}};
  EXPECT_LT(agree.p_value(), 1e-4);
  EXPECT_GT(disagree.p_value(), 0.3);
}

TEST(DiagnoseStatistics, SignFlipsCannotSayMoreThanTheNumberOfTrialsAllows) {
  const std::vector<TrialEvidence> all{{{5, 5, 5, 5}, {1, 1, 1, 1}}};
  EXPECT_DOUBLE_EQ(sign_flip_p_value(all, 0, 1), 1.0 / 8.0);
}

TEST(DiagnoseSignal, ADelayOfAFractionOfAStepIsThatDelay) {
  Signal signal{0.0, 1e-3, {}};
  for (int i = 0; i < 1000; ++i) signal.values.push_back(std::sin(20.0 * 1e-3 * i));
  Edits edits;
  edits.sensor("y", SensorEdit::Kind::delay_s, 0.6e-3);
  const std::vector<double> times{0.3004, 0.5001};
  std::vector<double> out(2);
  observe(signal, {}, edits, "y", times, out);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(out[i], std::sin(20.0 * (times[i] - 0.6e-3)), 1e-6);
}

TEST(DiagnoseSignal, ALagFollowsAStepExponentially) {
  Signal signal{0.0, 1e-4, std::vector<double>(1000, 1.0)};
  signal.values[0] = 0.0;
  signal.low_pass(5e-3);
  EXPECT_NEAR(signal.at(5e-3), 1.0 - std::exp(-1.0), 0.01);
}

TEST(DiagnoseEffects, AreAllOffAtZeroAndHaveSoundParameters) {
  std::set<std::string> ids;
  for (const auto& effect : known_effects()) {
    EXPECT_TRUE(ids.insert(effect.id).second) << effect.id << " twice";
    EXPECT_FALSE(effect.statement.empty()) << effect.id;
    EXPECT_FALSE(effect.equation.empty()) << effect.id;
    for (const auto plant : effect.plants) {
      Context context;
      context.plant = plant;
      for (const char* channel : {"height_m", "accel_mps2", "position_rad", "velocity_radps", "force_N"})
        context.channels[channel] = {0.0, 1.0, 0.01, 1e-3, 0.1, 0.0};
      context.belief.numbers["medium.density_kg_per_m3"] = 1.2;
      context.belief.numbers["body.volume_m3"] = 1e-3;
      context.belief.numbers["axis.gravity_torque_Nm"] = 1.0;
      for (const auto& candidate : candidates_for({effect}, context))
        for (const auto& p : candidate.parameters) {
          EXPECT_GT(p.typical, 0.0) << candidate.label() << " " << p.name;
          EXPECT_LE(p.low, p.high) << candidate.label() << " " << p.name;
          EXPECT_LE(p.typical, p.high) << candidate.label() << " " << p.name;
        }
    }
  }
  EXPECT_GT(ids.size(), 35u);
}

}  // namespace
}  // namespace sandhopper::diagnose
