#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_recording.hpp"
#include "tools/diagnose/plants/hopper/hopper_trial.hpp"
#include "tools/diagnose/plants/hopper/recorded_controller.hpp"

// Recorders differ in what a belief does not state: when within a row a sample is taken, how exact its time
// stamp is, what the first row of a hop holds. None of it is missing physics.
namespace sandhopper::diagnose {
namespace {

const std::vector<PhaseChange> kPhases{{0.0, HopperPhase::flight},
                                       {0.09, HopperPhase::compression},
                                       {0.25, HopperPhase::extension},
                                       {0.36, HopperPhase::flight}};

Trial hop() {
  HopperRun run = hop_from(0.04, 0.45);
  run.phases = &kPhases;
  return recorded(run);
}

// Root mean square of recorded minus simulated over the rows of a channel, with nothing fitted.
double misfit(const Trial& trial, const std::string& channel, const Belief& belief = {}) {
  Recordings r;
  r.plant = PlantKind::hopper;
  r.belief = belief;
  r.trials = {trial};
  r.beliefs = {belief};
  const Prepared prepared = prepare(r);
  const Problem& problem = prepared.problem;
  const Point point = null_point(problem);
  const TrialModel& model = *problem.trials.at(0);
  const auto simulated =
      predicted(problem, model, edits_for(problem, {}, point.tolerances), point.nuisances[0]);
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < model.rows.size(); ++k)
    if (problem.channels[model.rows[k].channel] == channel) {
      sum += std::pow(model.rows[k].measured - simulated[static_cast<Eigen::Index>(k)], 2);
      ++count;
    }
  return count > 0.0 ? std::sqrt(sum / count) : std::nan("");
}

Belief with_imu_rate(double rate_Hz) {
  Belief belief;
  belief.numbers["sensors.imu_rate_Hz"] = rate_Hz;
  return belief;
}

// A stamp that is 30 us late must not move the command that follows it by a whole cycle.
TEST(DiagnoseRecorder, LateStampsMoveNoCommandByACycle) {
  const Trial exact = hop();
  Trial late = exact;
  for (std::size_t i = 1; i < late.time_s.size(); ++i) late.time_s[i] += i % 10 == 0 ? 3e-5 : 0.0;
  const char* const current = "motor_left_current_A";
  EXPECT_LT(misfit(late, current), misfit(exact, current) + 0.05);
  // A current that follows one cycle later is seen at this bound.
  Trial next = exact;
  auto& amperes = next.channels[current];
  for (std::size_t i = amperes.size() - 1; i > 0; --i) amperes[i] = amperes[i - 1];
  EXPECT_GT(misfit(next, current), misfit(exact, current) + 0.2);
}

// The leg's rate bends where the command jumps at liftoff. Smoothing the recorded leg must not round that
// off: what follows from it would be a false current, and a leg that is off by a milliradian.
TEST(DiagnoseRecorder, TheLegAfterLiftoffIsThatOfTheRecording) {
  const Trial trial = hop();
  EXPECT_LT(misfit(trial, "motor_left_current_A"), 0.02);
  EXPECT_LT(misfit(trial, "motor_left_position_rad"), 2e-4);
}

TEST(DiagnoseRecorder, APhaseChangeBelongsToTheNearestCycle) {
  HopperCourse course;
  course.hops = {{.from_s = 0.1}, {.from_s = 0.5004}};
  course.phases = {{0.1, HopperPhase::flight},
                   {0.20003, HopperPhase::compression},
                   {0.29996, HopperPhase::extension},
                   {0.60045, HopperPhase::flight}};
  const auto at = at_cycles(course, 1e-3);
  EXPECT_NEAR(at[1].time_s, 0.2, 1e-9);
  EXPECT_NEAR(at[2].time_s, 0.3, 1e-9);
  EXPECT_NEAR(at[3].time_s, 0.6004, 1e-9);
  EXPECT_EQ(at[3].phase, HopperPhase::flight);
}

// Without the rows of `from_s` to `to_s`.
Trial without_rows(Trial trial, double from_s, double to_s) {
  const auto first = std::ranges::lower_bound(trial.time_s, from_s) - trial.time_s.begin();
  const auto last = std::ranges::lower_bound(trial.time_s, to_s) - trial.time_s.begin();
  for (auto& [name, values] : trial.channels)
    if (values.size() == trial.time_s.size()) values.erase(values.begin() + first, values.begin() + last);
  trial.time_s.erase(trial.time_s.begin() + first, trial.time_s.begin() + last);
  return trial;
}

// A gap of 30 ms over a touchdown: taken at the first row after it, the leg was 20 ms too long in flight, and
// the trial moved seven nuisances of a campaign in which nothing was missing.
TEST(DiagnoseRecorder, APhaseChangeAmongMissingRowsMayBeAnyOfThem) {
  const Trial whole = hop(), gap = without_rows(whole, 0.0805, 0.1105),
              one = without_rows(whole, 0.0895, 0.0905);
  EXPECT_EQ(phase_changes(whole)[1].unsure_s, 0.0);
  ASSERT_EQ(phase_changes(gap).size(), 4u);
  EXPECT_NEAR(phase_changes(gap)[1].time_s, 0.096, 1e-6);
  EXPECT_NEAR(phase_changes(gap)[1].unsure_s, 0.015, 1e-6);
  EXPECT_NEAR(phase_changes(one)[1].unsure_s, 5e-4, 1e-6);
  EXPECT_EQ(phase_changes(gap)[2].unsure_s, 0.0);
  const auto unsure_rows = [](const Trial& trial) {
    std::vector<double> rows;
    for (const auto& [sooner, later] : hopper_trial(trial, Belief{})->variants())
      if (later.kind == Variant::Kind::event) rows.push_back(later.amount);
    return rows;
  };
  EXPECT_NEAR(unsure_rows(whole).at(0), 0.5, 1e-9);
  EXPECT_NEAR(unsure_rows(gap).at(0), 15.5, 1e-3);
  EXPECT_NEAR(unsure_rows(gap).at(1), 0.5, 1e-9);
}

TEST(DiagnoseRecorder, ASwitchAmongMissingRowsIsNoLateOne) {
  const auto world = world_of(Belief{}, {});
  EXPECT_EQ(late_switches_s(hop(), world).size(), 1u);
  EXPECT_TRUE(late_switches_s(without_rows(hop(), 0.2405, 0.2605), world).empty());
  EXPECT_EQ(late_switches_s(without_rows(hop(), 0.0805, 0.1105), world).size(), 1u);
}

// Only a stated rate makes a sample older than its row: half a period in the mean.
TEST(DiagnoseRecorder, AnAccelerometerWhoseRateNobodyStatesIsSampledWithTheRow) {
  const Trial trial = hop();
  const char* const foot = "imu_foot_accel_z_mps2";
  const double stated = misfit(trial, foot, with_imu_rate(1666.0));
  EXPECT_GT(stated, 2.0 * misfit(trial, foot, with_imu_rate(9000.0)));
  EXPECT_GT(stated, 2.0 * misfit(trial, foot));
}

// The time of its samples is unsure by the age that a row's sample may have.
TEST(DiagnoseRecorder, TheAgeOfASampleIsATolerance) {
  const auto scale_s = [](double rate_Hz) {
    Recordings r;
    r.plant = PlantKind::hopper;
    r.belief = with_imu_rate(rate_Hz);
    r.trials = {hop()};
    r.beliefs = {r.belief};
    for (const auto& tolerance : prepare(r).problem.tolerances)
      if (tolerance.name == "time of imu_body_accel_z_mps2") return tolerance.scale;
    return 0.0;
  };
  EXPECT_NEAR(scale_s(9000.0), std::hypot(1.5e-4, 2.9e-4), 1e-5);
  EXPECT_NEAR(scale_s(2500.0), std::hypot(1.5e-4, 0.4 * 2.9e-4), 1e-5);
}

// At the release an accelerometer may still read the catch, 1 g, and its low-pass remembers that: 2.7 ms at
// 400 Hz, until 12 mm/s2 are left of it.
TEST(DiagnoseRecorder, WhatALowPassRemembersOfTheCatchSaysNothing) {
  Trial trial = hop();
  const char* const body = "imu_body_accel_z_mps2";
  const double before = misfit(trial, body);
  for (std::size_t i = 0; i < 3; ++i)
    trial.channels[body][i] += 9.81 * std::exp(-2.0 * std::numbers::pi * 0.4 * static_cast<double>(i));
  EXPECT_DOUBLE_EQ(misfit(trial, body), before);
  trial.channels[body][4] += 9.81;
  EXPECT_GT(misfit(trial, body), 2.0 * before);
}

// Commands and phases of the cycle before, beside the sensors at its end.
TEST(DiagnoseRecorder, CommandsOfTheCycleBeforeAreThoseOfTheirCycle) {
  const Trial exact = hop();
  Trial late = exact;
  for (auto& [name, values] : late.channels)
    if (name == "phase" || name.starts_with("command_"))
      std::rotate(values.rbegin(), values.rbegin() + 1, values.rend()), values.front() = values[1];
  EXPECT_FALSE(currents_follow_own_row(exact));
  EXPECT_TRUE(currents_follow_own_row(late));
  for (const char* channel :
       {"motor_left_current_A", "motor_left_position_rad", "command_left_torque_Nm", "load_cell_force_N"})
    EXPECT_LT(misfit(late, channel), 1.1 * misfit(exact, channel) + 1e-6) << channel;
}

}  // namespace
}  // namespace sandhopper::diagnose
