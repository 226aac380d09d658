#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/discrepancy/low_rank.hpp"
#include "tools/diagnose/discrepancy/port_error_evidence.hpp"
#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// Model error in the likelihood, and the evidence of an effect's size.
namespace sandhopper::diagnose {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

MatrixXd random_matrix(Eigen::Index rows, Eigen::Index cols, std::uint64_t seed) {
  Random random(seed, 0);
  MatrixXd out(rows, cols);
  for (double& value : out.reshaped()) value = random.normal();
  return out;
}

TEST(DiagnoseModelError, LowRankWhiteningIsThatOfTheDenseCovariance) {
  const MatrixXd columns =
      random_matrix(40, 5, 1) * Eigen::Vector<double, 5>(3.0, 1.0, 0.2, 10.0, 1e-3).asDiagonal();
  const MatrixXd covariance = MatrixXd::Identity(40, 40) + columns * columns.transpose();
  const LowRank low_rank(columns);
  const MatrixXd plain = random_matrix(40, 3, 2);
  MatrixXd white = plain;
  low_rank.whiten(white);
  const MatrixXd dense = plain.transpose() * covariance.inverse() * plain;
  EXPECT_LT((white.transpose() * white - dense).cwiseAbs().maxCoeff(), 1e-5 * dense.cwiseAbs().maxCoeff());
  EXPECT_NEAR(low_rank.log_determinant(), std::log(covariance.determinant()), 1e-4);
  const VectorXd residual = plain.col(0);
  const VectorXd expected = columns.transpose() * covariance.inverse() * residual;
  EXPECT_LT((low_rank.amplitudes(columns, residual) - expected).norm(), 1e-6 * expected.norm());
  EXPECT_GT(low_rank.taken_up(), 2.9);
  EXPECT_LT(low_rank.taken_up(), 5.0);
}

// Compared with the trapezoidal rule on a fine grid of the size.
TEST(DiagnoseModelError, TheSizeOfAnEffectIsIntegratedUnderItsLogNormalPrior) {
  const auto by_trapezoids = [](double best, double sd, bool either_sign) {
    const double spread = kLimits.size_spread, step = 1e-4;
    double sum = 0.0;
    for (double b = step; b < 40.0; b += step) {
      const double l = std::log(b) / spread;
      const double prior = std::exp(-0.5 * l * l) / (b * spread * std::sqrt(2.0 * std::numbers::pi));
      const auto likelihood = [&](double at) { return std::exp(-0.5 * std::pow((at - best) / sd, 2)); };
      sum += prior * step * (either_sign ? 0.5 * (likelihood(b) + likelihood(-b)) : likelihood(b));
    }
    return std::log(sum);
  };
  for (const double best : {0.0, 0.05, 1.0, -1.0, 6.0})
    for (const double sd : {0.02, 0.3, 5.0})
      for (const bool either_sign : {false, true}) {
        if (!either_sign && best < 0.0) continue;
        const double expected = by_trapezoids(best, sd, either_sign);
        if (expected < -500.0) continue;  // below the range of a double
        EXPECT_NEAR(log_integral_over_size(best, sd, either_sign), expected, 2e-3)
            << best << " +- " << sd << (either_sign ? ", either sign" : "");
      }
}

Recordings hops_with_liftoff(double later_s, std::size_t count) {
  Recordings r;
  r.plant = PlantKind::hopper;
  for (std::size_t i = 0; i < count; ++i) {
    const double late_s = i % 2 == 0 ? later_s : -later_s;
    const std::vector<PhaseChange> phases{{0.0, HopperPhase::flight},
                                          {0.09, HopperPhase::compression},
                                          {0.25, HopperPhase::extension},
                                          {0.36, HopperPhase::flight}};
    auto really = phases;
    really.back().time_s += late_s;
    HopperRun run = hop_from(0.04 + 0.002 * static_cast<double>(i), 0.45);
    run.phases = &really;
    run.switch_between_cycles = true;
    Trial trial = recorded(run, {}, i + 1);
    for (std::size_t k = 0; k < trial.time_s.size(); ++k)
      trial.channels["phase"][k] = static_cast<double>(phase_at(phases, trial.time_s[k]));
    // Commands are left out: they follow exactly from the recorded phase.
    for (const char* side : {"left", "right"})
      trial.channels.erase("command_" + std::string(side) + "_torque_Nm");
    trial.name = std::to_string(i);
    r.trials.push_back(std::move(trial));
    r.beliefs.push_back(r.belief);
  }
  return r;
}

// Mean squared whitened residual per row, with sensor noise alone and with model error added.
struct PerRow {
  double noise_alone = 0.0, with_model_error = 0.0;
};
PerRow per_row(const Recordings& recordings) {
  Prepared prepared = prepare(recordings);
  Problem& problem = prepared.problem;
  const Point point = null_point(problem);
  PerRow out;
  take_model_error(problem, model_errors(problem, point));
  const Edits base = edits_for(problem, {}, point.tolerances);
  for (std::size_t t = 0; t < problem.trials.size(); ++t) {
    const TrialModel& trial = *problem.trials[t];
    const VectorXd plain = residual_of(trial, predicted(problem, trial, base, point.nuisances[t]));
    MatrixXd white = plain;
    whiten(problem, t, white);
    const auto rows = static_cast<double>(trial.rows.size() * problem.trials.size());
    out.with_model_error += white.squaredNorm() / rows;
    white = plain;
    problem.noise.whiten(trial, problem.used[t], white);
    out.noise_alone += white.squaredNorm() / rows;
  }
  return out;
}

// Hops with the dry friction of the belief, as a program simulates them whose friction changes its sign
// within `switch_factor` times the believed speeds. `more`: friction that the belief lacks, relative.
Recordings hops_with_friction(double switch_factor, double more) {
  Recordings r;
  r.plant = PlantKind::hopper;
  Edits edits;
  for (const char* key : {"robot.rail_coulomb_N", "robot.joint_coulomb_Nm"}) edits.scale(key, 1.0 + more);
  for (int i = 0; i < 4; ++i) {
    HopperRun run = hop_from(0.04 + 0.004 * i, 0.45, edits);
    run.friction_switch_factor = switch_factor;
    r.trials.push_back(recorded(run, {}, static_cast<std::uint64_t>(i) + 1));
    r.trials.back().name = std::to_string(i);
    r.beliefs.push_back(r.belief);
  }
  return r;
}

// The belief does not say how dry friction changes its sign. Another program's way must not count as a
// misfit; more friction must.
TEST(DiagnoseModelError, SetValuedFrictionIsNoMisfit) {
  const auto same = per_row(hops_with_friction(1.0, 0.0)), sharp = per_row(hops_with_friction(0.1, 0.0)),
             more = per_row(hops_with_friction(1.0, 0.5));
  EXPECT_GT(sharp.noise_alone, 1.3 * same.noise_alone);
  EXPECT_LT(sharp.with_model_error, 1.05 * same.with_model_error);
  EXPECT_GT(more.with_model_error, 1.3 * same.with_model_error);
}

// Largest difference that the sharper friction makes, if the belief's rail changes its sign within `speed`.
double effect_of_sharper_friction(double rail_switch_speed_mps) {
  auto recordings = hops_with_friction(1.0, 0.0);
  for (auto* belief : {&recordings.belief, &recordings.beliefs.front()}) {
    belief->numbers["robot.rail_friction_switch_speed_mps"] = rail_switch_speed_mps;
    belief->numbers["robot.joint_coulomb_Nm"] = 0.0;
  }
  Prepared prepared = prepare(recordings);
  const Point point = null_point(prepared.problem);
  const Edits base = edits_for(prepared.problem, {}, point.tolerances);
  const TrialModel& trial = *prepared.problem.trials.front();
  const VectorXd plain = predicted(prepared.problem, trial, base, point.nuisances.front());
  VectorXd other = plain;
  trial.predict_variant(trial.variants().back().later, base, point.nuisances.front(),
                        {other.data(), static_cast<std::size_t>(other.size())});
  return (other - plain).cwiseAbs().maxCoeff();
}

// The steps do not resolve speeds below the sharpest that a belief may state, so these have no sharper
// variant.
TEST(DiagnoseModelError, FrictionThatIsSharpInTheBeliefHasNoSharperVariant) {
  constexpr double kSharpest = WorldRobotConfig::kSharpestRail_mps;
  EXPECT_GT(effect_of_sharper_friction(10.0 * kSharpest), 1e-3);
  EXPECT_EQ(effect_of_sharper_friction(kSharpest), 0.0);
}

// A recorded phase change is known only to one row. A liftoff that is half a row off must not count as a
// misfit.
TEST(DiagnoseModelError, ALiftoffHalfARowOffTheRecordedOneIsNoMisfit) {
  const auto as_recorded = per_row(hops_with_liftoff(0.0, 4)), off = per_row(hops_with_liftoff(4e-4, 4)),
             far = per_row(hops_with_liftoff(4e-3, 4));
  std::printf(
      "deviance a row: as recorded %.2f, half a row off %.2f, with model error %.2f, four rows off %.2f\n",
      as_recorded.with_model_error, off.noise_alone, off.with_model_error, far.with_model_error);
  EXPECT_GT(off.noise_alone - as_recorded.noise_alone,
            3.0 * (off.with_model_error - as_recorded.with_model_error));
  EXPECT_LT(off.with_model_error, as_recorded.with_model_error + 0.1);
  EXPECT_GT(far.with_model_error, as_recorded.with_model_error + 0.3);
}

// Hops on whose rail a force acts that no effect describes: smooth in time, different in every trial.
Recordings hops_with_rail_force(double force_N) {
  Recordings r;
  r.plant = PlantKind::hopper;
  for (int i = 0; i < 4; ++i) {
    Edits edits;
    edits.law(LawPort::rail, [=](const PortState& s) {
      return force_N * std::sin(2.0 * std::numbers::pi * time_of(s) / 0.12 + 1.7 * i);
    });
    r.trials.push_back(recorded(hop_from(0.04 + 0.004 * i, 0.45), edits, static_cast<std::uint64_t>(i) + 1));
    r.trials.back().name = std::to_string(i);
    r.beliefs.push_back(r.belief);
  }
  return r;
}

// A port error is learnt where there is one, and none where there is none.
TEST(DiagnoseModelError, TheEvidenceOfAPortErrorFindsItsSize) {
  const std::vector<double> sizes{0.0, 0.01, 0.3};
  const auto without = port_error_evidence(hops_with_rail_force(0.0), sizes),
             with = port_error_evidence(hops_with_rail_force(0.1), sizes);
  std::printf("without %.1f %.1f %.1f, with %.1f %.1f %.1f\n", without[0], without[1], without[2], with[0],
              with[1], with[2]);
  EXPECT_GT(without[0], without[2]);
  EXPECT_GT(with[1], with[0]);
  EXPECT_GT(with[1], with[2]);
}

TEST(DiagnoseModelError, TheNoiseAddsTheDeterminantOfItsWhitening) {
  Recordings recordings = hops_with_rail_force(0.0);
  Prepared prepared = prepare(recordings);
  Problem& problem = prepared.problem;
  update_noise(problem, null_point(problem));
  const TrialModel& trial = *problem.trials[0];
  const auto rows = static_cast<Eigen::Index>(trial.rows.size());
  MatrixXd map = MatrixXd::Identity(rows, rows);
  problem.noise.whiten(trial, problem.used[0], map);
  double expected = 0.0;
  for (Eigen::Index k = 0; k < rows; ++k)
    if (problem.used[0][static_cast<std::size_t>(k)]) expected += std::log(map(k, k));
  EXPECT_LT(map.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm(), 1e-12);
  EXPECT_NEAR(problem.noise.log_determinant(trial, problem.used[0]), expected, 1e-6 * std::abs(expected));
}

}  // namespace
}  // namespace sandhopper::diagnose
