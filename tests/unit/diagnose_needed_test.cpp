#include <gtest/gtest.h>

#include "tools/diagnose/evidence/needed.hpp"

// Limits from which the trials need an effect: each with a case just inside and one just outside.
namespace sandhopper::diagnose {
namespace {

// An effect that every trial shows alike: clear by Student's t, and by sign flips.
EffectEvidence evidence(double p_value = 1e-6, double flip_p_value = 0.01) {
  EffectEvidence e;
  e.evidence.score.assign(8, 1.0);
  e.evidence.information.assign(8, 1.0);
  e.gain = 50.0;
  e.p_value = p_value;
  e.flip_p_value = flip_p_value;
  e.typicals = 1.0;
  return e;
}

// One of two effects, in eight trials; it gains little of what both explain.
BesideEvidence beside() {
  return {.trials = 8, .effects = 2, .rows = 1000.0, .form_error = 0.05, .drop = 50.0, .explained = 1e6};
}

bool is_sound(EffectEvidence e, const BesideEvidence& b) { return need_of(e, b).is_sound; }

TEST(DiagnoseNeeded, AnEffectBesideAnotherNeedsOnePerCent) {
  EXPECT_TRUE(is_sound(evidence(0.009), beside()));
  EXPECT_FALSE(is_sound(evidence(0.011), beside()));
}

TEST(DiagnoseNeeded, AnEffectAloneNeedsFivePerCentIfFlipsConfirmIt) {
  auto alone = beside();
  alone.effects = 1;
  EXPECT_TRUE(is_sound(evidence(0.045), alone));
  EXPECT_FALSE(is_sound(evidence(0.055), alone));
  EXPECT_TRUE(is_sound(evidence(1e-6, 0.045), alone));
  EXPECT_FALSE(is_sound(evidence(1e-6, 0.055), alone));
  alone.trials = 5;  // too few to flip
  EXPECT_FALSE(is_sound(evidence(0.045), alone));
}

TEST(DiagnoseNeeded, ItIsWeakAboveOnePerCent) {
  auto strong = evidence(0.009), weak = evidence(0.011);
  need_of(strong, beside());
  need_of(weak, beside());
  EXPECT_FALSE(strong.weak);
  EXPECT_TRUE(weak.weak);
}

TEST(DiagnoseNeeded, BesideAStrongerLawOfUnsureFormAndInManyTrialsItNeedsMuchMore) {
  auto doubted = beside();
  doubted.trials = 10;
  doubted.is_strongest = false;
  EXPECT_TRUE(is_sound(evidence(0.9e-4), doubted));
  EXPECT_FALSE(is_sound(evidence(1.1e-4), doubted));
  auto few = doubted, sure = doubted, unsure = doubted;
  few.trials = 9;
  sure.form_error = 0.009;
  unsure.form_error = 0.011;
  EXPECT_TRUE(is_sound(evidence(1e-3), few));
  EXPECT_TRUE(is_sound(evidence(1e-3), sure));
  EXPECT_FALSE(is_sound(evidence(1e-3), unsure));
}

TEST(DiagnoseNeeded, FlipsCountFromSixTrialsOn) {
  auto few = beside(), enough = beside();
  few.trials = 5;
  enough.trials = 6;
  EXPECT_TRUE(is_sound(evidence(1e-6, 0.5), few));
  EXPECT_FALSE(is_sound(evidence(1e-6, 0.5), enough));
}

TEST(DiagnoseNeeded, FlipsDoNotCountIfFewTrialsCarryTheInformation) {
  const auto carried_by = [](std::size_t trials, double p_value) {
    auto e = evidence(p_value, 0.5);
    for (std::size_t t = trials; t < 8; ++t) e.evidence.information[t] = 1e-6;
    return e;
  };
  EXPECT_TRUE(is_sound(carried_by(5, 0.9e-4), beside()));
  EXPECT_FALSE(is_sound(carried_by(5, 1.1e-4), beside()));
  EXPECT_FALSE(is_sound(carried_by(6, 0.9e-4), beside()));
}

TEST(DiagnoseNeeded, ALargeEffectBeyondDoubtNeedsNoFlips) {
  auto large = beside();
  large.explained = 50.0 / 0.022;
  EXPECT_TRUE(is_sound(evidence(0.9e-8, 0.5), large));
  EXPECT_FALSE(is_sound(evidence(1.1e-8, 0.5), large));
  large.explained = 50.0 / 0.018;
  EXPECT_FALSE(is_sound(evidence(0.9e-8, 0.5), large));
}

// The least p-value by flips at the fit of one of sixteen effects is 16 * 2^(1 - T): below 5 % from ten
// trials on.
TEST(DiagnoseNeeded, FlipsThatCannotTellOneOfManyEffectsDoNotCountAgainstALargeOne) {
  auto large = beside();
  large.explained = 100.0;
  large.candidates = 16;
  auto nine = evidence(0.9e-4, 0.5);
  nine.evidence.score.assign(9, 1.0);
  nine.evidence.information.assign(9, 1.0);
  auto ten = nine;
  ten.evidence.score.assign(10, 1.0);
  ten.evidence.information.assign(10, 1.0);
  EXPECT_TRUE(is_sound(nine, large));
  EXPECT_FALSE(is_sound(ten, large));
  nine.p_value = 1.1e-4;
  EXPECT_FALSE(is_sound(nine, large));
  large.explained = 1e6;  // A small one is flipped without it, against all effects at once.
  nine.p_value = 0.9e-4;
  EXPECT_FALSE(is_sound(nine, large));
}

TEST(DiagnoseNeeded, WhatTheFitDoesNotBearOutNeedsFlips) {
  auto large = beside();
  large.explained = 100.0;
  large.drop = 0.32 * 50.0;
  EXPECT_TRUE(is_sound(evidence(1e-9, 0.5), large));
  large.drop = 0.28 * 50.0;
  EXPECT_FALSE(is_sound(evidence(1e-9, 0.5), large));
}

TEST(DiagnoseNeeded, ASmallEffectIsNotNamedUnlessItsGainIsUnmistakable) {
  const auto is_too_small = [](double typicals, double gain) {
    auto e = evidence();
    e.typicals = typicals;
    e.gain = gain;
    need_of(e, beside());
    return e.too_small;
  };
  EXPECT_TRUE(is_too_small(0.075, 50.0));
  EXPECT_FALSE(is_too_small(0.085, 50.0));
  EXPECT_TRUE(is_too_small(0.01, 280.0));
  EXPECT_FALSE(is_too_small(0.01, 320.0));
}

TEST(DiagnoseNeeded, NoBetterFitIsTriedForAHopelessEffect) {
  const auto is_hopeless = [](double p_value, double typicals) {
    auto e = evidence(p_value);
    e.typicals = typicals;
    return need_of(e, beside()).is_hopeless;
  };
  EXPECT_FALSE(is_hopeless(0.19, 1.0));
  EXPECT_TRUE(is_hopeless(0.21, 1.0));
  EXPECT_FALSE(is_hopeless(1e-6, 0.042));
  EXPECT_TRUE(is_hopeless(1e-6, 0.038));
}

// Drops of the trials alternate in sign, so only their sum tells.
TEST(DiagnoseNeeded, TheDropMustBeAtLeastATwentiethOfTheLinearGain) {
  Fit with, without;
  with.trial_deviance = {10.0, 12.0, 10.0, 12.0, 10.0, 12.0, 10.0, 12.0};
  without.trial_deviance = {12.0, 10.0, 12.0, 10.0, 12.0, 10.0, 12.0, 10.0};
  with.deviance = 100.0;
  without.deviance = 104.5;
  EXPECT_FALSE(comes_true(without, with, 100.0));
  without.deviance = 105.5;
  EXPECT_TRUE(comes_true(without, with, 100.0));
}

// Wilcoxon's test reaches 1/16 with four trials and 1/32 with five.
TEST(DiagnoseNeeded, OrEveryTrialMustBeWorseWithoutTheEffect) {
  const auto all_worse = [](std::size_t trials) {
    Fit with, without;
    with.trial_deviance.assign(trials, 10.0);
    without.trial_deviance.assign(trials, 10.1);
    return comes_true(without, with, 100.0);
  };
  EXPECT_FALSE(all_worse(4));
  EXPECT_TRUE(all_worse(5));
}

TEST(DiagnoseNeeded, NuisancesHaveAbsorbedSomethingIfMuchIsLeftOrAllLean) {
  EXPECT_FALSE(have_absorbed(1450.0, 1000.0, 0.0));
  EXPECT_TRUE(have_absorbed(1550.0, 1000.0, 0.0));
  EXPECT_FALSE(have_absorbed(1000.0, 1000.0, -3.8));
  EXPECT_TRUE(have_absorbed(1000.0, 1000.0, -4.2));
}

TEST(DiagnoseNeeded, AnOffsetIsRemovedIfMostOfItGoes) {
  EXPECT_TRUE(removes_offset(-10.0, 5.8));
  EXPECT_FALSE(removes_offset(-10.0, 6.2));
  EXPECT_FALSE(removes_offset(3.8, 0.0));
  EXPECT_TRUE(removes_offset(4.2, 0.0));
}

}  // namespace
}  // namespace sandhopper::diagnose
