#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/report_parts.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/residuals.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<TrialMisfit> trials_with(std::initializer_list<double> deviance_per_row) {
  std::vector<TrialMisfit> trials;
  for (const double d : deviance_per_row) trials.push_back({1000.0 * d, 1000.0});
  return trials;
}

TEST(DiagnoseMisfit, NothingBeyondTheNoiseIsNoMisfit) {
  const auto m = misfit_of(trials_with({1.0, 0.9, 1.05, 0.95}), 5000.0, false);
  EXPECT_NEAR(m.unexplained, -100.0, 1e-9);
  EXPECT_NEAR(m.explained, 1100.0, 1e-9);
  EXPECT_FALSE(m.large);
  EXPECT_FALSE(m.noticeable);
}

TEST(DiagnoseMisfit, MuchThatIsLeftIsLargeUnlessTenTimesAsMuchIsExplained) {
  const auto trials = trials_with({1.7, 1.8, 1.7, 1.8});
  EXPECT_TRUE(misfit_of(trials, 7000.0 + 20000.0, false).large);
  EXPECT_FALSE(misfit_of(trials, 7000.0 + 40000.0, false).large);
  EXPECT_TRUE(misfit_of(trials, 7000.0 + 40000.0, false).noticeable);
}

TEST(DiagnoseMisfit, LittleThatIsLeftOutweighsWhatExplainsNotMuchMore) {
  const auto trials = trials_with({1.2, 1.15, 1.12, 1.2});
  EXPECT_TRUE(misfit_of(trials, 4670.0 + 400.0, false).outweighs);
  EXPECT_FALSE(misfit_of(trials, 4670.0 + 400.0, false).large);
  EXPECT_TRUE(misfit_of(trials, 4670.0 + 2000.0, false).outweighs);
  EXPECT_FALSE(misfit_of(trials, 4670.0 + 2500.0, false).outweighs);
  EXPECT_FALSE(misfit_of(trials_with({1.05, 1.0, 1.1, 1.0}), 4160.0, false).outweighs);
  EXPECT_FALSE(misfit_of(trials_with({1.04, 1.04, 1.04, 1.04}), 4170.0, false).outweighs);
  EXPECT_TRUE(misfit_of(trials_with({1.07, 1.07, 1.07, 1.07}), 4290.0, false).outweighs);
}

TEST(DiagnoseMisfit, OneTrialThatWentAstrayIsNoMisfitOfAll) {
  EXPECT_FALSE(misfit_of(trials_with({1.0, 1.0, 1.0, 9.0}), 12000.0, false).large);
  EXPECT_TRUE(misfit_of(trials_with({1.0, 1.0, 5.0, 9.0}), 16000.0, false).large);
  EXPECT_TRUE(misfit_of(trials_with({1.0, 1.0, 1.0, 1.0, 5.0, 9.0}), 18000.0, true).large);
  EXPECT_FALSE(misfit_of(trials_with({1.0, 1.0, 1.0, 1.0, 5.0, 9.0}), 18000.0, false).large);
  EXPECT_FALSE(misfit_of(trials_with({9.0, 9.0}), 18000.0, false).large);
}

TEST(DiagnoseMisfit, TheUnknownIsPlacedAtThePortOfTheNearestPhysicsNotOfASensor) {
  const auto found = [](const std::string& id, const std::string& port, const std::string& channel = "") {
    FoundEffect effect;
    effect.id = id;
    effect.port = port;
    effect.channel = channel;
    return effect;
  };
  Diagnosis d;
  d.effects = {found("load_cell.lag", "load_cell_force_N", "load_cell_force_N"),
               found("terrain.crust", "ground"), found("rail.viscous", "rail")};
  report_unknown_near(0.13, d);
  ASSERT_EQ(d.effects.size(), 4u);
  EXPECT_EQ(d.effects.back().id, "unknown@ground");
  EXPECT_LE(d.effects.back().probability, 0.5);
  EXPECT_NE(d.effects.back().statement.find("at ground: 87 % of the gap; terrain.crust comes nearest"),
            std::string::npos);
  d.effects.resize(1);
  report_unknown_near(0.13, d);
  EXPECT_EQ(d.effects.size(), 1u);
}

// A tether that becomes tight below 3 m.
double tether(double, double height_m, double) { return 0.4 * std::max(0.0, 3.0 - height_m); }
double nothing(double, double, double) { return 0.0; }

double left_of(const Recordings& recordings) {
  auto prepared = prepare(recordings);
  Problem& problem = prepared.problem;
  const auto fit = fit_from(problem, null_point(problem));
  update_noise(problem, fit.point);
  const Fit again = fit_from(problem, fit.point);
  return left_over_noise(problem, again, again).after;
}

TEST(DiagnoseMisfit, TheShareThatIsLeftIsThatOfTheExcessOverTheNoise) {
  EXPECT_NEAR((LeftOver{.before = 5.0, .after = 2.0}).share(), 3.0 / 24.0, 1e-12);
  EXPECT_EQ((LeftOver{.before = 5.0, .after = 0.9}).share(), 0.0);
  EXPECT_EQ((LeftOver{.before = 2.0, .after = 2.5}).share(), 1.0);
}

TEST(DiagnoseMisfit, MoreThanTheNoiseIsLeftWhereSomethingIsMissing) {
  EXPECT_LT(left_of(drops(nothing)), 1.2);
  EXPECT_GT(left_of(drops(tether)), 1.5);
}

// Hum has another phase in every trial. No law of time, depth or force describes it, so it looks like noise.
TEST(DiagnoseMisfit, WhatScattersFarBeyondItsSensorIsUnknownThere) {
  auto recordings = presses([](double, double) { return 0.0; }, 3, 8);
  EXPECT_EQ(diagnose(recordings).verdict, Verdict::consistent);
  for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
    auto& trial = recordings.trials[i];
    auto& force = trial.channels["force_N"];
    for (std::size_t k = 0; k < force.size(); ++k)
      force[k] += 1.0 * std::sin(2.0 * M_PI * 50.0 * trial.time_s[k] + 2.4 * static_cast<double>(i));
  }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::unknown_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "unknown@force_N");
}

TEST(DiagnoseMisfit, NamesThatLeaveOtherTrialsNoNearerGainNothing) {
  const auto prepared = prepare(drops(nothing, 1, 4));
  const Problem& problem = prepared.problem;
  Point null;
  for (const auto& trial : problem.trials) null.nuisances.emplace_back(trial->nuisance_count(), 0.0);
  Point point = null;
  const auto gain = [&](double held_out) {
    Residuals residuals;
    for (const auto& trial : problem.trials) {
      residuals.before.emplace_back(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(trial->rows.size())));
      residuals.held_out.emplace_back(held_out * residuals.before.back());
    }
    return held_out_gain(problem, residuals, null, point);
  };
  EXPECT_GT(gain(0.9), 0.0);
  EXPECT_EQ(gain(1.0), 0.0);
  EXPECT_LT(gain(1.1), 0.0);
  // A lower prior cost of the nuisance parameters counts as a gain, too.
  const Nuisance& release = problem.trials.front()->trial_nuisances.front();
  ASSERT_TRUE(release.shift_is_evidence);
  null.nuisances.front().front() = 3.0 * release.sd;
  EXPECT_DOUBLE_EQ(gain(1.0), 9.0);
}

TEST(DiagnoseMisfit, OfSensorsThatNobodyDescribedItIsNotSaid) {
  auto recordings = drops(tether);
  for (const char* key : {"sensors.height_noise_m", "sensors.accel_noise_mps2"}) {
    recordings.belief.numbers.erase(key);
    for (auto& belief : recordings.beliefs) belief.numbers.erase(key);
  }
  EXPECT_EQ(left_of(recordings), 0.0);
}

TEST(DiagnoseMisfit, TrialsLeanByWhatTheyHaveInCommon) {
  const auto prepared = prepare(drops(nothing));
  const auto& problem = prepared.problem;
  const auto& first = problem.trials.front()->trial_nuisances;
  ASSERT_GE(first.size(), 2u);
  ASSERT_GE(problem.trials.size(), 4u);
  const auto trials = static_cast<double>(problem.trials.size());
  Point point = null_point(problem);
  EXPECT_EQ(largest_common_shift(problem, point).z, 0.0);
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    point.nuisances[t][0] = -1.5 * problem.trials[t]->trial_nuisances[0].sd;  // equal in all trials
    // different between trials
    point.nuisances[t][1] = (t % 2 == 0 ? 5.0 : -5.0) * problem.trials[t]->trial_nuisances[1].sd;
  }
  const auto shift = largest_common_shift(problem, point);
  EXPECT_EQ(shift.nuisance, first[0].name);
  EXPECT_NEAR(shift.z, -1.5 * std::sqrt(trials), 1e-12);
}

TEST(DiagnoseMisfit, WhatLeansIsUnknownWhereItActs) {
  Diagnosis d;
  report_unknown_shift({"release_height_m", "", 9.0}, d);
  EXPECT_TRUE(d.effects.empty());
  report_unknown_shift({"bed_fluctuation", "ground", -9.0}, d);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "unknown@ground");
  EXPECT_NE(d.effects.front().statement.find("bed_fluctuation"), std::string::npos);
  EXPECT_NE(d.effects.front().statement.find("9.0 standard errors"), std::string::npos);
}

TEST(DiagnoseMisfit, TheChangeOfANoiseIsThatOfItsLogarithm) {
  const std::vector<double> sd{0.1, 2.0}, larger{0.11, 2.2};
  const auto before = white_noise(sd, 3);
  EXPECT_EQ(noise_change(before, before), 0.0);
  EXPECT_NEAR(noise_change(before, white_noise(larger, 3)), std::sqrt(2.0) * std::log(1.1), 1e-12);
}

}  // namespace
}  // namespace sandhopper::diagnose
