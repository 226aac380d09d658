#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// An axis that runs free is simulated in long stretches first, and in shorter ones if the answer leaves more
// than the noise.
namespace sandhopper::diagnose {
namespace {

// A pendulum that swings free for 6 s. `kick_Nm` acts for a tenth of a second at a time of its own in each
// trial.
Recordings free_swings(double viscous_Nm_s, double kick_Nm) {
  constexpr double kInertia_kg_m2 = 0.1, kGravityTorque_Nm = 2.0, kStep_s = 1e-4;
  Recordings r = swings([](double, double, double) { return 0.0; }, 1, 4);
  for (std::size_t i = 0; i < r.trials.size(); ++i) {
    Random random(7, i);
    Trial& trial = r.trials[i];
    trial.time_s.clear();
    for (auto& [name, values] : trial.channels) values.clear();
    double angle = 0.6 + 0.1 * static_cast<double>(i), speed = 0.0;
    const double kick_s = 2.0 + 0.7 * static_cast<double>(i);
    for (long step = 0; step < 60'000; ++step) {
      const double t = kStep_s * static_cast<double>(step);
      if (step % 100 == 0) {
        trial.time_s.push_back(t);
        trial.channels["position_rad"].push_back(angle + 5e-4 * random.normal());
        trial.channels["velocity_radps"].push_back(speed + 0.02 * random.normal());
        trial.channels["torque_Nm"].push_back(0.0);
      }
      const double kick = std::abs(t - kick_s) < 0.05 ? kick_Nm : 0.0;
      speed += kStep_s / kInertia_kg_m2 * (kick - kGravityTorque_Nm * std::sin(angle) - viscous_Nm_s * speed);
      angle += kStep_s * speed;
    }
  }
  return r;
}

bool used_shorter_stretches(const Diagnosis& d) {
  return std::ranges::any_of(d.log,
                             [](const auto& line) { return line.starts_with("again in shorter stretches"); });
}

TEST(DiagnoseStretches, OnlyAnAxisThatRunsFreeHasLongOnes) {
  const auto free = free_swings(0.0, 0.0);
  const auto whole = prepare(free, 0), short_ones = prepare(free, 2);
  EXPECT_EQ(whole.problem.trials.front()->blocks, 1u);
  EXPECT_GT(short_ones.problem.trials.front()->blocks, 8u);
  const auto driven = swings([](double, double, double) { return 0.0; });
  EXPECT_EQ(prepare(driven).problem.plant->stretches(driven.trials).size(), 1u);
}

TEST(DiagnoseStretches, AWeakFrictionIsFoundOverAWholeSwing) {
  constexpr double kViscous_Nm_s = 2e-4;
  const auto d = diagnose(free_swings(kViscous_Nm_s, 0.0));
  EXPECT_FALSE(used_shorter_stretches(d));
  ASSERT_FALSE(d.effects.empty()) << to_text(d);
  EXPECT_EQ(d.effects.front().id, "axis.viscous") << to_text(d);
  EXPECT_NEAR(d.effects.front().parameters.front().value, kViscous_Nm_s, 0.2 * kViscous_Nm_s);
}

TEST(DiagnoseStretches, WhatAddsUpAlongAWholeSwingIsForgivenInShortOnes) {
  EXPECT_TRUE(used_shorter_stretches(diagnose(free_swings(2e-4, 0.05))));
}

}  // namespace
}  // namespace sandhopper::diagnose
