#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>
#include <set>

#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/noise_model.hpp"
#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/model/effect.hpp"
#include "tools/diagnose/model/sign_smooth.hpp"
#include "tools/diagnose/model/signal.hpp"
#include "tools/diagnose/plants/intruder/bed_grains.hpp"

namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseStatistics, ASmoothSignIsTheHyperbolicTangent) {
  for (double x = -12.0; x <= 12.0; x += 0.01)
    EXPECT_NEAR(sign_smooth(0.02 * x, 0.02), std::tanh(x), 4e-8) << x;
  EXPECT_EQ(sign_smooth(1e300, 0.02), 1.0);
  EXPECT_EQ(sign_smooth(-1e300, 0.02), -1.0);
}

TEST(DiagnoseStatistics, StudentTailsAreThoseOfTables) {
  EXPECT_NEAR(student_t_two_sided(2.228, 10.0), 0.05, 1e-4);
  EXPECT_NEAR(student_t_two_sided(4.604, 4.0), 0.01, 1e-4);
  EXPECT_NEAR(student_t_quantile(0.05, 10.0), 2.228, 1e-3);
  EXPECT_NEAR(student_t_two_sided(0.0, 3.0), 1.0, 1e-12);
  EXPECT_EQ(student_t_two_sided(std::nan(""), 3.0), 1.0);
  EXPECT_EQ(student_t_two_sided(HUGE_VAL, 3.0), 0.0);
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

// Compared with an enumeration of all sign combinations.
TEST(DiagnoseStatistics, SignedRanksCountEverySign) {
  const std::vector<double> all{3.0, 0.1, 40.0, 2.0, 5.0, 0.7, 9.0, 1.0};
  EXPECT_DOUBLE_EQ(signed_rank_p_value(all), 1.0 / 256.0);
  const std::vector<double> mixed{3.0, -0.1, 40.0, -2.0, 5.0};  // ranks 3, -1, 5, -2, 4
  int reached = 0;
  for (int signs = 0; signs < 32; ++signs) {
    int sum = 0;
    for (int rank = 1; rank <= 5; ++rank) sum += (signs >> (rank - 1)) & 1 ? rank : 0;
    reached += sum >= 12;
  }
  EXPECT_DOUBLE_EQ(signed_rank_p_value(mixed), reached / 32.0);
  EXPECT_DOUBLE_EQ(signed_rank_p_value({}), 1.0);
}

TEST(DiagnoseStatistics, EffectiveTrialsAreThoseThatCarryTheInformation) {
  EXPECT_DOUBLE_EQ((TrialEvidence{{1, 1, 1, 1}, {2, 2, 2, 2}}.effective_trials()), 4.0);
  EXPECT_NEAR((TrialEvidence{{1, 1, 1, 1}, {100, 1e-3, 1e-3, 1e-3}}.effective_trials()), 1.0, 1e-3);
}

TEST(DiagnoseStatistics, EqualTrialsScatterByTheirSampleVariance) {
  const std::vector<double> score{1.0, 4.0, -2.0, 5.0}, information(4, 2.0);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(4, 4, -0.5);  // 2 delta - 2 * 2 / 8
  covariance.diagonal().array() += 2.0;
  const std::vector<double> left{-1.0, 2.0, -4.0, 3.0};  // score less its mean
  const auto between = scatter_between(left, information, covariance);
  EXPECT_NEAR(between.ratio, 30.0 / 3.0 / 2.0, 1e-12);
  EXPECT_NEAR(between.degrees_of_freedom, 3.0, 1e-12);
  const TrialEvidence evidence{score, information};
  EXPECT_NEAR(evidence.scatter().degrees_of_freedom, 7.0, 1e-12);
  EXPECT_NEAR(evidence.scatter().ratio, (4.0 + 3.0 * 5.0) / 7.0, 1e-12);
  EXPECT_NEAR(evidence.standard_error(), std::sqrt(evidence.scatter().ratio / 8.0), 1e-12);
}

// Size 2: the scores are off by 0, 3, 0 and -3. A trial without information does not count.
TEST(DiagnoseStatistics, TheDispersionCountsEveryTrialAlike) {
  const TrialEvidence evidence{{200.0, 7.0, 8.0, -1.0, 0.0}, {100.0, 2.0, 4.0, 1.0, 0.0}};
  EXPECT_NEAR(evidence.size(), 2.0, 1e-12);
  EXPECT_NEAR(evidence.dispersion(), (4.0 + 9.0 / 2.0 + 9.0) / 7.0, 1e-12);
}

TEST(DiagnoseStatistics, ATrialThatDeterminesTheSizeAloneSaysNothingOfTheScatter) {
  const TrialEvidence alone{{5.0}, {1.0}};
  EXPECT_DOUBLE_EQ(alone.scatter().ratio, 1.0);
  EXPECT_DOUBLE_EQ(alone.scatter().degrees_of_freedom, 4.0);
  const TrialEvidence among{{5e9, 0.0, 0.0}, {1e9, 0.0, 0.0}};
  EXPECT_DOUBLE_EQ(among.scatter().ratio, 1.0);
  EXPECT_DOUBLE_EQ(among.scatter().degrees_of_freedom, 4.0);
}

// Quadratic drag in hops from four heights: the information goes with the fourth power of the speed. Scores
// of pure noise must be called significant as often as the level says. The sum of squared scores, with a
// degree of freedom for each trial, called them so four times as often at 0.1 %.
TEST(DiagnoseStatistics, TrialsOfVeryDifferentInformationKeepTheLevel) {
  std::vector<double> information;
  for (const double height : {0.05, 0.11, 0.23, 0.5})
    information.insert(information.end(), 3, std::pow(height, 4));
  std::mt19937_64 engine(11);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 40'000;
  double five = 0.0, one_in_1000 = 0.0, ratio = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    TrialEvidence evidence{{}, information};
    for (const double i : information) evidence.score.push_back(std::sqrt(i) * normal(engine));
    five += evidence.p_value() < 0.05;
    one_in_1000 += evidence.p_value() < 1e-3;
    ratio += evidence.scatter().ratio;
  }
  EXPECT_LT(five / kDraws, 0.05);
  EXPECT_GT(five / kDraws, 0.01);
  EXPECT_LT(one_in_1000 / kDraws, 1e-3);
  EXPECT_NEAR(ratio / kDraws, 1.0, 0.02);
}

// If the trials scatter 2.28 times as much as the noise, the noise's share in the pooled scatter lets 0.4 %
// pass at 0.1 % (tools/diagnose/README.md).
TEST(DiagnoseStatistics, TrialsThatScatterMoreThanTheNoisePassMoreOftenThanTheLevelSays) {
  std::mt19937_64 engine(12);
  std::normal_distribution<double> normal;
  constexpr int kDraws = 40'000;
  double passed = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    TrialEvidence evidence;
    for (const double height : {0.05, 0.11, 0.23, 0.5})
      for (int repeat = 0; repeat < 3; ++repeat) {
        evidence.information.push_back(std::pow(height, 4));
        evidence.score.push_back(2.28 * std::sqrt(evidence.information.back()) * normal(engine));
      }
    passed += evidence.p_value() < 1e-3;
  }
  EXPECT_NEAR(passed / kDraws, 0.004, 0.001);  // three standard errors
}

// Products of residual and one column of a trial: score u and information h.
Eigen::MatrixXd gram_of(double u, double h) { return Eigen::MatrixXd{{1e3, u}, {u, h}}; }

TEST(DiagnoseStatistics, WhatOtherTrialsSayNothingOfIsNotPredicted) {
  const Eigen::MatrixXd prior = Eigen::MatrixXd::Constant(1, 1, 0.25);
  // Only one trial determines the size. The predictions from the others must not count against it.
  const auto alone =
      held_out_gain({gram_of(1e4, 1e4), gram_of(-0.03, 1e-3), gram_of(-0.03, 1e-3)}, {1}, prior);
  EXPECT_NEAR(alone.of_trial[0], 0.0, 100.0);  // at full size it would cost 5,300
  // Three consistent trials predict each other.
  const auto agree = held_out_gain({gram_of(90, 100), gram_of(100, 100), gram_of(110, 100)}, {1}, prior);
  for (const double gain : agree.of_trial) EXPECT_GT(gain, 70.0);
}

// Screening beside a tolerance at its limit must not count on a further change of this tolerance.
TEST(DiagnoseFit, AToleranceAtItsLimitIsHeld) {
  Problem problem;
  problem.tolerances = {{"time of a channel", 1e-4, "height_m"}, {"time of another", 1e-4, "force_N"}};
  Point point;
  point.tolerances = {kMostTolerance, -0.9 * kMostTolerance};
  const auto prior = prior_information(problem, point);
  ASSERT_EQ(prior.size(), 2);
  EXPECT_GT(prior[0], 1e9);
  EXPECT_DOUBLE_EQ(prior[1], 1.0);
}

class RowsOnly final : public TrialModel {
 public:
  void predict(const Edits&, std::span<const double>, std::span<double>) const override {}
};

TEST(DiagnoseNoise, NoPastPredictsBetterThanTheSensorsOwnNoise) {
  // A residual as smooth as a wave seems predictable to a thousandth, but the sensor's noise of 0.1 is not.
  RowsOnly trial;
  constexpr std::size_t kRows = 2000;
  Eigen::VectorXd residual(kRows);
  for (std::size_t k = 0; k < kRows; ++k) {
    trial.rows.push_back({.time_s = 1e-3 * static_cast<double>(k)});
    residual[static_cast<Eigen::Index>(k)] = std::sin(0.01 * static_cast<double>(k));
  }
  const std::vector<double> floor{0.1};
  const auto noise = estimate_noise({&trial}, {std::vector<std::uint8_t>(kRows, 1)}, {residual}, 1, floor);
  const auto& channel = noise.channel(0);
  EXPECT_NEAR(channel.correlation_of_phase[0].innovation_sd * channel.sd_of_phase[0], 0.1, 1e-6);
}

// A command at the torque limit repeats exactly. The noise of the others must not look smaller for it.
TEST(DiagnoseNoise, RowsAtTheirLimitSayNothingOfTheNoise) {
  RowsOnly trial;
  constexpr std::size_t kRows = 2000;
  Eigen::VectorXd residual(kRows);
  for (std::size_t k = 0; k < kRows; ++k) {
    trial.rows.push_back({.time_s = 1e-3 * static_cast<double>(k), .at_limit = k % 4 != 0});
    residual[static_cast<Eigen::Index>(k)] = k % 4 != 0 ? 0.0 : k % 8 == 0 ? 0.3 : -0.3;
  }
  const std::vector<double> floor{1e-6};
  const auto noise = estimate_noise({&trial}, {std::vector<std::uint8_t>(kRows, 1)}, {residual}, 1, floor);
  EXPECT_NEAR(noise.channel(0).sd_of_phase[0], 0.3, 1e-9);
}

// The first example of Benjamini and Hochberg (1995), section 3.2: at 5 % the four smallest of 15 are
// rejected, although Bonferroni's method rejects three.
TEST(DiagnoseStatistics, FalseDiscoveriesAreCountedAsByBenjaminiAndHochberg) {
  const std::vector<double> p{0.0459, 0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298,
                              0.0344, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
  std::size_t count = 0;
  for (const bool rejected : rejected_at_false_discovery_rate(p, 0.05)) count += rejected;
  EXPECT_EQ(count, 4u);
  EXPECT_FALSE(rejected_at_false_discovery_rate(p, 0.05)[0]);
  EXPECT_TRUE(rejected_at_false_discovery_rate(p, 0.05)[4]);
  EXPECT_TRUE(rejected_at_false_discovery_rate({}, 0.05).empty());
}

TEST(DiagnosePlants, GrainsMakeOfAWholePressWhatTheirCorrelationSays) {
  // Variance of the mean over a depth D of an exponentially correlated fluctuation: about 2 L / D times its
  // own.
  constexpr double kLength_m = 0.002, kDepth_m = 0.04, kRelative = 0.02;
  const BedGrains grains(kRelative, kLength_m, kDepth_m, kLength_m, 40);
  std::mt19937_64 generator(7);
  std::normal_distribution<double> normal(0.0, grains.sd());
  double squares = 0.0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    std::vector<double> nuisances(grains.count());
    for (double& n : nuisances) n = normal(generator);
    const auto fluctuation = grains.fluctuation(nuisances);
    double mean = 0.0;
    constexpr int kSteps = 400;
    for (int k = 0; k < kSteps; ++k) mean += (fluctuation.factor(kDepth_m * k / kSteps) - 1.0) / kSteps;
    squares += mean * mean / kDraws;
  }
  EXPECT_NEAR(squares / (kRelative * kRelative), 2.0 * kLength_m / kDepth_m,
              0.25 * 2.0 * kLength_m / kDepth_m);
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

// A mean over steps that jumps between two of them: the low-pass must follow the jump where it happens, not
// from the middle of the step before. Values at the ends of the steps are exact.
TEST(DiagnoseSignal, ALowPassFollowsAJumpOfMeansWhereItHappens) {
  constexpr double kStep_s = 5e-4, kJump_s = 0.01, kTime_s = 4e-4;
  const auto at = [&](double time_s, bool means) {
    Signal signal{0.5 * kStep_s, kStep_s, {}, means};
    for (int i = 0; i < 100; ++i) signal.values.push_back(kStep_s * i < kJump_s - 1e-9 ? 0.0 : 1.0);
    signal.low_pass(kTime_s);
    return signal.at(time_s);
  };
  EXPECT_NEAR(at(kJump_s, true), 0.0, 1e-12);
  EXPECT_GT(at(kJump_s, false), 0.05);
  for (int steps = 1; steps < 4; ++steps)
    EXPECT_NEAR(at(kJump_s + steps * kStep_s, true), 1.0 - std::exp(-steps * kStep_s / kTime_s), 1e-12);
}

TEST(DiagnoseEffects, AreAllOffAtZeroAndHaveSoundParameters) {
  std::set<std::pair<std::string, PlantKind>> ids;
  for (const auto& effect : known_effects()) {
    for (const auto plant : effect.plants)
      EXPECT_TRUE(ids.insert({effect.id, plant}).second) << effect.id << " twice";
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
