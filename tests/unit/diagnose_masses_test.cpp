#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tools/diagnose/answer/masses.hpp"
#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/evidence/calibration.hpp"
#include "tools/diagnose/evidence/form_error.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/evidence/search_parts.hpp"

// Numbers that decide how probable a name is: each held from both sides.
namespace sandhopper::diagnose {
namespace {

FoundEffect effect(double mass, double heldout_gain = 1.0, const std::string& id = "air.drag") {
  FoundEffect found;
  found.id = id;
  found.mass = mass;
  found.heldout_gain = heldout_gain;
  return found;
}

TEST(DiagnoseMasses, ASmallEffectBesideALargeOneIsAtMost70PerCent) {
  std::vector<FoundEffect> effects{effect(0.12, 0.12), effect(0.95, 0.9), effect(0.95, 0.14),
                                   effect(0.95, 0.12)};
  effects.front().mass = 0.69;
  limit_beside_each_other(effects);
  EXPECT_EQ(effects[0].mass, 0.95);
  EXPECT_EQ(effects[1].mass, 0.95) << "14 %";
  EXPECT_EQ(std::min(effects[2].mass, effects[3].mass), 0.69);
  EXPECT_NEAR(std::max(effects[2].mass, effects[3].mass), 0.7, 1e-12);
}

TEST(DiagnoseMasses, ASmallFaultOfASensorPutsTheLargeLawInDoubt) {
  for (const double share : {0.12, 0.14}) {
    std::vector<FoundEffect> effects{effect(0.95, 0.9), effect(0.95, share)};
    effects.back().channel = "force_N";
    limit_beside_each_other(effects);
    EXPECT_NEAR(effects.front().mass, share < 0.13 ? 0.7 : 0.95, 1e-12);
  }
}

TEST(DiagnoseMasses, NamesCarryTheVerdictIfTheyCloseMostOfTheGap) {
  for (const double closed : {0.47, 0.53}) {
    std::vector<FoundEffect> effects{effect(0.99)};
    EXPECT_EQ(limit_by_rest(effects, {.gap_closed = closed, .has_law = true}), closed > 0.5);
  }
  for (const double mass : {0.47, 0.53}) {
    std::vector<FoundEffect> effects{effect(mass)};
    EXPECT_EQ(limit_by_rest(effects, {.gap_closed = 0.9}), mass > 0.5);
  }
}

TEST(DiagnoseMasses, BesideSomethingUnknownNamesAreAtMost70PerCentAndItIsAtMostHalf) {
  std::vector<FoundEffect> effects{effect(0.99), effect(0.69), effect(0.9, 1.0, "unknown@ground"),
                                   effect(0.48, 1.0, "unknown@body")};
  EXPECT_TRUE(limit_by_rest(effects, {.unknown = true}));
  EXPECT_NEAR(effects[0].mass, 0.7, 1e-12);
  EXPECT_NEAR(effects[1].mass, 0.69, 1e-12);
  EXPECT_NEAR(effects[2].mass, 0.5, 1e-12);
  EXPECT_NEAR(effects[3].mass, 0.48, 1e-12);
}

TEST(DiagnoseMasses, AMassIsThatOfTheGapThatNamesClose) {
  std::vector<FoundEffect> effects{effect(0.8), effect(0.6, 1.0, "unknown@ground")};
  EXPECT_FALSE(limit_by_rest(effects, {.gap_closed = 0.4, .unknown = true}));
  EXPECT_NEAR(effects[0].mass, 0.32, 1e-12);
  EXPECT_EQ(effects[1].mass, 0.6);
}

TEST(DiagnoseMasses, WithoutACheckOfTheRestNamesAreAtMost70PerCent) {
  std::vector<FoundEffect> effects{effect(0.99), effect(0.69)};
  EXPECT_TRUE(limit_by_rest(effects, {.not_checked = true}));
  EXPECT_NEAR(effects[0].mass, 0.7, 1e-12);
  EXPECT_NEAR(effects[1].mass, 0.69, 1e-12);
}

TEST(DiagnoseMasses, AnUnknownEffectIsAtLeastHalfSure) {
  EXPECT_NEAR(mass_of_unknown(0.0), 1.0, 1e-12);
  EXPECT_NEAR(mass_of_unknown(0.004), 0.8, 1e-12);
  EXPECT_NEAR(mass_of_unknown(0.3), 0.5, 1e-12);
}

TEST(DiagnoseMasses, AWeakEffectAloneIsAtMost75PerCent) {
  EXPECT_NEAR(mass_alone(0.95, true), 0.75, 1e-12);
  EXPECT_EQ(mass_alone(0.74, true), 0.74);
  EXPECT_EQ(mass_alone(0.95, false), 0.95);
}

TEST(DiagnoseMasses, AProbabilityIsTheMassUpToTheFrequencyOfFullMass) {
  const std::pair<double, double> map[]{{0.0, 0.0}, {0.4, 0.4}, {0.87, 0.87}, {0.88, 0.877}, {1.0, 0.877}};
  for (const auto& [mass, probability] : map) EXPECT_NEAR(calibrated(mass), probability, 1e-12) << mass;
}

TEST(DiagnoseMasses, WhatTheRecordingsShowDirectlyIsNearlySure) {
  Diagnosis d;
  report_data_faults({{.channel = "force_N", .id = "data.stuck", .stretches = 3, .trials = {}}}, d);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_GT(d.effects.front().probability, 0.95);
  EXPECT_LT(d.effects.front().probability, 1.0);
}

TEST(DiagnoseMasses, AnUnknownEffectWithoutALawIsHalfSure) {
  Diagnosis d;
  report_unknown_noise({"force_N", 6.0, "force_N"}, d);
  EXPECT_NEAR(d.effects.front().mass, 0.5, 1e-12);
}

TEST(DiagnosePosterior, DifferencesCountLessThanTheFormsOfLawsAreUnsure) {
  EXPECT_NEAR(share_in_doubt(0.001), 2e-4, 1e-12);
  EXPECT_NEAR(share_in_doubt(0.05), 1e-3, 1e-12);
  EXPECT_NEAR(temperature_with(0.0), 1.0, 1e-12);
  EXPECT_NEAR(temperature_with(10.0), 2.0, 1e-12);
}

// A problem of so many candidates with one amplitude each, of any sign.
Problem with_candidates(std::size_t count) {
  Problem problem;
  for (std::size_t i = 0; i < count; ++i) {
    Candidate candidate;
    candidate.parameters = {{.typical = 2.0, .low = -100.0, .high = 100.0}};
    problem.candidates.push_back(std::move(candidate));
  }
  return problem;
}

SetFit fit_of_size(double typicals) {
  SetFit fit;
  fit.set = {0};
  fit.fit.point.hypothesis = {{0}, {{2.0 * typicals}}};
  return fit;
}

TEST(DiagnosePriors, AnEffectCostsItsPriorAndItsParameter) {
  const Problem problem = with_candidates(3);
  const Search search(problem, {});
  const double cost = search.criterion(fit_of_size(1.0)) - search.criterion(SetFit());
  // One of 40 is missing; something is twice as often missing as one more; one parameter, fewer than 3
  // trials.
  EXPECT_NEAR(cost, 2.0 * std::log(40.0) - 2.0 * std::log(2.0) + std::log(3.0), 1e-9);
}

TEST(DiagnosePriors, SizesFarFromTheTypicalOneAreLessProbable) {
  const Problem problem = with_candidates(3);
  const Search search(problem, {});
  const double typical = search.criterion(fit_of_size(1.0));
  EXPECT_NEAR(search.criterion(fit_of_size(std::exp(1.0))) - typical, 1.0, 1e-9);
  EXPECT_NEAR(search.criterion(fit_of_size(std::exp(-1.8))) - typical, 1.0, 1e-9);
}

TEST(DiagnosePriors, ASetCostsTheEffectsExpectedAndTheStatementsItContradicts) {
  Problem problem = with_candidates(20);
  EXPECT_NEAR(log_prior(problem, {0, 1}), 2.0 * std::log(1.0 / 20.0), 1e-9);
  problem.candidates[1].contradicts_belief = true;
  EXPECT_NEAR(log_prior_of_statements(problem, {0, 1}), std::log(0.01), 1e-9);
}

// A sharp likelihood takes the density at its centre: log-normal around 1 with ln-spread 1.
TEST(DiagnosePriors, TheSizeIsLogNormalAroundTheTypicalOne) {
  const double sd = 1e-3;
  const auto at = [&](double size) {
    return log_integral_over_size(size, sd, false) - std::log(sd * std::sqrt(2.0 * std::numbers::pi));
  };
  EXPECT_NEAR(at(1.0), -0.5 * std::log(2.0 * std::numbers::pi), 1e-3);
  EXPECT_NEAR(at(std::exp(1.0)), at(1.0) - 1.5, 1e-3);
}

TEST(DiagnosePriors, ANameStaysInQuestionDownToATwentiethOfTheBest) {
  EXPECT_TRUE(can_be_exchanged(0.055));
  EXPECT_FALSE(can_be_exchanged(0.045));
}

// Twenty times as probable, as a drop of twice the logarithm.
TEST(DiagnosePriors, SetsCanBeExchangedUpToTwentyToOne) {
  EXPECT_GT(kWorthAFit, 5.9);
  EXPECT_LT(kWorthAFit, 6.1);
}

TEST(DiagnosePriors, TheFormOfALawIsUnsureByTenPerCentAndItsSizeByFive) {
  const Eigen::MatrixXd covariance = form_information(1).inverse();
  EXPECT_NEAR(covariance(0, 0), 0.1 * 0.1 + 0.05 * 0.05, 1e-6);
  EXPECT_NEAR(covariance(0, kFormKnots - 1),
              0.1 * 0.1 * std::exp(-0.5 * static_cast<double>(kFormKnots - 1)) + 0.05 * 0.05, 1e-6);
}

TEST(DiagnosePriors, AnAmplitudeIsKnownToTenTypicalSizes) {
  const Problem problem = with_candidates(1);
  Point point;
  point.hypothesis = {{0}, {{2.0}}};
  EXPECT_NEAR(prior_information(problem, point)[0], 0.01, 1e-12);
}

}  // namespace
}  // namespace sandhopper::diagnose
