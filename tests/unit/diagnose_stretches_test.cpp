#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/unit/diagnose_free_swings.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// An axis that runs free is simulated in long stretches first, and in shorter ones if the answer leaves more
// than the noise.
namespace sandhopper::diagnose {
namespace {

bool used_shorter_stretches(const Diagnosis& d) {
  return std::ranges::any_of(
      d.log, [](const auto& line) { return line.starts_with("searched again in shorter stretches"); });
}

TEST(DiagnoseStretches, OnlyAnAxisThatRunsFreeHasLongOnes) {
  const auto free = free_swings({});
  const auto whole = prepare(free, 0), short_ones = prepare(free, 2);
  EXPECT_EQ(whole.problem.trials.front()->blocks, 1u);
  EXPECT_GT(short_ones.problem.trials.front()->blocks, 8u);
  const auto driven = swings([](double, double, double) { return 0.0; });
  EXPECT_EQ(prepare(driven).problem.plant->stretches(driven.trials).size(), 1u);
}

TEST(DiagnoseStretches, AWeakFrictionIsFoundOverAWholeSwing) {
  constexpr double kViscous_Nm_s = 2e-4;
  const auto d = diagnose(free_swings({.viscous_Nm_s = kViscous_Nm_s}));
  EXPECT_FALSE(used_shorter_stretches(d));
  ASSERT_FALSE(d.effects.empty()) << to_text(d);
  EXPECT_EQ(d.effects.front().id, "axis.viscous") << to_text(d);
  EXPECT_NEAR(d.effects.front().parameters.front().value, kViscous_Nm_s, 0.2 * kViscous_Nm_s);
}

TEST(DiagnoseStretches, WhatAddsUpAlongAWholeSwingIsForgivenInShortOnes) {
  EXPECT_TRUE(used_shorter_stretches(diagnose(free_swings({.viscous_Nm_s = 2e-4, .kick_Nm = 0.05}))));
}

}  // namespace
}  // namespace sandhopper::diagnose
