#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/spread_seen.hpp"
#include "tools/diagnose/model/effect.hpp"
#include "tools/diagnose/plants/ground_laws.hpp"
#include "tools/diagnose/plants/hopper/recorded_controller.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/intruder/intruder_motion.hpp"

// Differences between recordings of other programs and ours that are no physics.
namespace sandhopper::diagnose {
namespace {

// A converter with its own clock: each sample appears in the first row after it.
struct Sampled {
  Trial trial;
  std::vector<double> ages_s;
};
Sampled sampled_at(double rate_Hz, double phase) {
  Sampled out;
  auto& force = out.trial.channels["load_cell_force_N"];
  double before = std::floor(-phase);
  for (int row = 0; row < 600; ++row) {
    const double t = 1e-3 * row, tick = std::floor(t * rate_Hz - phase);
    out.trial.time_s.push_back(t);
    force.push_back(tick > before || row == 0 ? 1.0 : std::numeric_limits<double>::quiet_NaN());
    if (!std::isnan(force.back())) out.ages_s.push_back(t - (tick + phase) / rate_Hz);
    before = tick;
  }
  return out;
}

TEST(DiagnoseAnotherProgram, TheAgeOfASampleIsFoundThoughItsClockIsOff) {
  for (const double off : {-0.06, -0.01, 0.0, 0.013, 0.05}) {
    const auto made = sampled_at(860.0 * (1.0 + off), 0.37);
    const auto ages = ages_s(made.trial, "load_cell_force_N", 860.0);
    ASSERT_EQ(ages.size(), made.ages_s.size()) << "clock off by " << off;
    double worst_s = 0.0;
    for (std::size_t i = 1; i < ages.size(); ++i)
      worst_s = std::max(worst_s, std::abs(ages[i] - made.ages_s[i]));
    EXPECT_LT(worst_s, 6e-5) << "clock off by " << off;
  }
  EXPECT_TRUE(ages_s(sampled_at(600.0, 0.2).trial, "load_cell_force_N", 860.0).empty());
}

// The leg is released where the encoder reads the angle that the controller holds. With an encoder offset the
// true angle differs by it.
TEST(DiagnoseAnotherProgram, ALegIsLetGoWhereItsEncoderReadsIt) {
  const HopperRun run = hop_from(0.04, 0.1);
  Edits off;
  for (const char* channel : {"motor_left_position_rad", "motor_right_position_rad"})
    off.sensor(channel, SensorEdit::Kind::offset, 0.02);
  EXPECT_NEAR(simulate_hopper(run, {}).angle_rad.values.front(), run.start.angle_rad, 1e-12);
  EXPECT_NEAR(simulate_hopper(run, off).angle_rad.values.front(), run.start.angle_rad - 0.02, 1e-12);
}

// A delay of +-0.1 ms must change the motion symmetrically.
TEST(DiagnoseAnotherProgram, ADriveMayBeALittleEarlyAsWellAsLate) {
  const HopperRun run = hop_from(0.04, 0.3);
  const auto angle_with = [&](double late_s) {
    Edits edits;
    if (late_s != 0.0) edits.sensor("actuator", SensorEdit::Kind::delay_s, late_s);
    return simulate_hopper(run, edits).angle_rad.values;
  };
  const auto early = angle_with(-1e-4), now = angle_with(0.0), late = angle_with(1e-4);
  double apart = 0.0, skew = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    apart = std::max(apart, std::abs(late[i] - early[i]));
    skew = std::max(skew, std::abs(late[i] + early[i] - 2.0 * now[i]));
  }
  EXPECT_GT(apart, 1e-4);
  EXPECT_LT(skew, 0.1 * apart);
}

// Force of the bed on a foot that turns round at `deepest_m`: just before, and `above_m` above it on the way
// out.
struct TurnedRound {
  double before_N, after_N;
};
TurnedRound turned_round(const char* id, const std::vector<double>& values, double deepest_m,
                         double above_m) {
  const Recordings r = presses([](double, double) { return 0.0; });
  const Prepared prepared = prepare(r);
  const auto& candidates = prepared.problem.candidates;
  const auto it = std::ranges::find_if(candidates, [&](const Candidate& c) { return c.effect->id == id; });
  Edits edits;
  it->effect->apply(prepared.problem.context, "", values, edits);
  const GroundLaws laws(edits, {.pushes = 4.0, .wait_s = 300.0});
  Bed bed({.stiffness_N_per_m = 1500.0,
           .intercept_depth_m = 0.0,
           .added_mass_factor = 0.0,
           .drag_factor = 0.0,
           .unloading_stiffness_ratio = 30.0},
          0.04);
  bed.extend(&laws);
  const BedContact down{
      .depth_m = deepest_m, .speed_mps = 0.05, .max_depth_m = deepest_m, .damping_mass_kg = 0.0};
  BedContact up = down;
  up.depth_m -= above_m;
  up.speed_mps = -0.05;
  return {bed.reaction(down).force_N, bed.reaction(up).force_N};
}

// Programs differ in how a crust's force ends at the turning point: along the unloading line, or at once.
TEST(DiagnoseAnotherProgram, ACrustIsUnloadedOrGoneAtOnce) {
  const auto unloaded = turned_round("terrain.crust", {3.0, 0.002, 1.0, 1.0}, 0.02, 1e-9);
  EXPECT_NEAR(unloaded.before_N, 33.0, 1e-3);
  EXPECT_NEAR(unloaded.after_N, unloaded.before_N, 1e-3);
  const auto gone = turned_round("terrain.crust", {3.0, 0.002, 1.0, 0.0}, 0.02, 1e-9);
  EXPECT_NEAR(gone.before_N, 33.0, 1e-3);
  EXPECT_NEAR(gone.after_N, 30.0, 1e-3);
}

// An unloading line of 45 N/mm loses 18 N in 0.4 mm, one of 54 N/mm loses 21.6 N.
TEST(DiagnoseAnotherProgram, AStifferBedMayHaveAStifferUnloadingLine) {
  const double share = 0.2 / (1.0 - std::exp(-2.0));  // gives 20 % after 4 pushes
  const auto whole = turned_round("terrain.compaction", {share, 2.0, 1.0}, 0.02, 4e-4);
  EXPECT_NEAR(whole.before_N, 36.0, 1e-6);
  EXPECT_NEAR(whole.before_N - whole.after_N, 21.6, 1e-6);
  const auto loading_only = turned_round("terrain.compaction", {share, 2.0, 0.0}, 0.02, 4e-4);
  EXPECT_NEAR(loading_only.before_N, 36.0, 1e-6);
  EXPECT_NEAR(loading_only.before_N - loading_only.after_N, 18.0, 1e-6);
}

// A foot that moves 30 mm down and up within 0.2 s, sampled at 1 kHz.
struct Plunge {
  Samples z, v, a;
  static double depth_m(double t) { return 0.015 * (1.0 - std::cos(10.0 * M_PI * t)); }
};
Plunge plunge() {
  Plunge p;
  const double w = 10.0 * M_PI;
  for (int i = 0; i <= 200; ++i) {
    const double t = 1e-3 * i;
    for (auto* samples : {&p.z, &p.v, &p.a}) samples->time_s.push_back(t);
    const double tiny = i % 2 == 0 ? 1.0 : -1.0;  // quantisation
    p.z.value.push_back(-Plunge::depth_m(t) + 1e-5 * tiny);
    p.v.value.push_back(-0.015 * w * std::sin(w * t) + 1e-3 * tiny);
    p.a.value.push_back(-0.015 * w * w * std::cos(w * t) + 5e-2 * tiny);
  }
  return p;
}

double worst_depth_m(const IntruderMotion& m) {
  double worst_m = 0.0;
  for (std::size_t i = 0; i < m.depth_m.size(); ++i)
    worst_m = std::max(
        worst_m, std::abs(m.depth_m[i] - Plunge::depth_m(m.start_s + m.step_s * static_cast<double>(i))));
  return worst_m;
}

TEST(DiagnoseAnotherProgram, AFastFootIsOnAFinerGridThanItsRecording) {
  const auto p = plunge();
  const auto m = intruder_motion(p.z, p.v, p.a);
  EXPECT_LE(m.step_s * 0.47, 1.6e-4);  // travel per step at the largest speed, 0.47 m/s
  EXPECT_LT(worst_depth_m(m), 2e-5);
}

// A camera at 240 Hz with 0.2 mm of noise, and an accelerometer with an offset. The speed ramps last 1.7 ms,
// two samples of the accelerometer; there is no speed channel. At rest both sensors together must give the
// depth better than the mean of five frames.
TEST(DiagnoseAnotherProgram, ASlowCameraAndAnAccelerometerWithAnOffsetAreOneMotion) {
  constexpr double kSpeed_mps = 0.1, kRamp_mps2 = 60.0, kOffset_mps2 = 0.1, kNoise_m = 2e-4;
  constexpr double kDown_s = 0.2003, kStop_s = 0.6, kRamp_s = kSpeed_mps / kRamp_mps2;
  const auto speed_mps = [](double t) {
    return std::clamp(std::min(t - kDown_s, kStop_s - t) / kRamp_s, 0.0, 1.0) * kSpeed_mps;
  };
  Random random(5, 0);
  Samples z, a;
  double depth_m = 0.0, next_frame_s = 0.0;
  for (int i = 0; i <= 10'000; ++i) {
    const double t = 1e-4 * i;
    if (i % 10 == 0) {
      a.time_s.push_back(t);
      a.value.push_back(-(speed_mps(t + 1e-5) - speed_mps(t)) / 1e-5 + kOffset_mps2 + 0.1 * random.normal());
      if (t >= next_frame_s) {
        next_frame_s += 1.0 / 240.0;
        z.time_s.push_back(t);
        z.value.push_back(-depth_m + kNoise_m * random.normal());
      }
    }
    depth_m += 1e-4 * speed_mps(t + 5e-5);
  }
  const auto m = intruder_motion(z, {}, a);
  EXPECT_FALSE(m.speed_from_position);
  double squares = 0.0, accel = 0.0, count = 0.0;
  for (std::size_t i = 0; i < m.depth_m.size(); ++i) {
    const double t = m.start_s + m.step_s * static_cast<double>(i);
    if (t < kStop_s + 0.02 || t > 0.98) continue;
    squares += std::pow(m.depth_m[i] - depth_m, 2);
    accel += m.accel_mps2[i];
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.4 * kNoise_m);  // the mean of five frames has 0.45
  EXPECT_NEAR(accel / count, 0.0, 0.03);
}

// Samples between the third and the fourth were removed at a limit. A mean over the gap would be a reading at
// a time without a reading.
TEST(DiagnoseAnotherProgram, NoMeanIsTakenAcrossAGap) {
  const Samples samples{{0.001, 0.002, 0.003, 0.103, 0.104, 0.105}, {5.0, 5.0, 5.0, 5.0, 5.0, 5.0}};
  const auto taken = means(samples, slow_groups(samples, 4, 1.0));
  ASSERT_EQ(taken.time_s.size(), 2u);
  EXPECT_NEAR(taken.time_s[0], 0.002, 1e-12);
  EXPECT_NEAR(taken.time_s[1], 0.104, 1e-12);
}

// A straight line over the gap of 80 ms would be wrong by 5 mm or more.
TEST(DiagnoseAnotherProgram, AGapOfThePositionIsBridgedByItsRates) {
  auto p = plunge();
  p.z.time_s.erase(p.z.time_s.begin() + 60, p.z.time_s.begin() + 140);
  p.z.value.erase(p.z.value.begin() + 60, p.z.value.begin() + 140);
  EXPECT_LT(worst_depth_m(intruder_motion(p.z, p.v, p.a)), 2e-4);
}

// Commands of a controller that acts on the samples of the previous cycle.
TEST(DiagnoseAnotherProgram, ACommandMayGoWithTheLegOfTheRowBefore) {
  const HopperRun run = hop_from(0.04, 0.3);
  Trial trial = recorded(run, {}, 5);
  const Leg leg(run.world.robot.leg);
  const auto commands = [&](RecordedController controller, bool by_age) {
    if (by_age) controller.find_age(run.world, run.compression_stiffness_N_per_m, phase_changes(trial));
    std::vector<double> out(trial.time_s.size());
    controller.commands_Nm(run.world, run.compression_stiffness_N_per_m, phase_changes(trial), trial.time_s,
                           out);
    return out;
  };
  const RecordedController as_read(trial, leg, run.world, run.to_s);
  const auto at_once = commands(as_read, false);
  const std::size_t rows = trial.time_s.size();
  for (const char* channel : {"command_left_torque_Nm", "command_right_torque_Nm"})
    for (std::size_t i = rows; i-- > 1;) trial.channels[channel][i] = at_once[i - 1];
  const RecordedController late(trial, leg, run.world, run.to_s);
  const auto at_age = commands(late, true);
  double worst = 0.0, worst_at_once = 0.0;
  for (std::size_t i = 3; i < rows; ++i) {
    worst = std::max(worst, std::abs(at_age[i] - trial.channels["command_left_torque_Nm"][i]));
    worst_at_once =
        std::max(worst_at_once, std::abs(at_once[i] - trial.channels["command_left_torque_Nm"][i]));
  }
  EXPECT_GT(worst_at_once, 0.05);
  EXPECT_LT(worst, 0.2 * worst_at_once);
}

Recordings few_hops() {
  Recordings r;
  r.plant = PlantKind::hopper;
  for (int t = 0; t < 4; ++t) {
    r.trials.push_back(recorded(hop_from(0.03 + 0.01 * t, 0.3), {}, static_cast<std::uint64_t>(t) + 1));
    r.trials.back().name = std::to_string(t);
    r.beliefs.emplace_back();
  }
  return r;
}

// The belief allows 2 % between trials. All trials are off by 3 % and differ by only 0.02 %, so the offset is
// an effect, no spread.
TEST(DiagnoseAnotherProgram, WhatAllTrialsShareIsAnEffectsToExplain) {
  auto prepared = prepare(few_hops());
  Problem& problem = prepared.problem;
  const auto& first = problem.trials.front()->trial_nuisances;
  const auto torque = static_cast<std::size_t>(
      std::ranges::find(first, "torque_constant_relative", &Nuisance::name) - first.begin());
  ASSERT_LT(torque, first.size());
  const double believed = first[torque].sd;
  Point point = null_point(problem);
  for (std::size_t t = 0; t < problem.trials.size(); ++t)
    point.nuisances[t][torque] = -0.03 + 2e-4 * (static_cast<double>(t) - 1.5);
  const auto starts = take_spread_as_seen(problem, point);
  EXPECT_LT(first[torque].sd, 0.1 * believed);
  EXPECT_FALSE(first[torque].shift_is_evidence);
  EXPECT_EQ(point.nuisances[0][torque], 0.0);
  const auto start = std::ranges::find_if(starts, [&](const Point& p) {
    return problem.candidates[p.hypothesis.candidates.front()].label() == "actuator.torque_constant";
  });
  ASSERT_NE(start, starts.end());
  EXPECT_NEAR(start->hypothesis.values.front().front(), -0.03, 1e-3);
}

TEST(DiagnoseAnotherProgram, WhereTrialsDifferAsBelievedNothingIsShared) {
  auto prepared = prepare(few_hops());
  Problem& problem = prepared.problem;
  const auto& first = problem.trials.front()->trial_nuisances;
  Point point = null_point(problem);
  std::vector<double> before;
  for (std::size_t i = 0; i < first.size(); ++i) {
    before.push_back(first[i].sd);
    for (std::size_t t = 0; t < problem.trials.size(); ++t)
      point.nuisances[t][i] = (t % 2 == 0 ? 0.9 : -1.1) * first[i].sd;
  }
  EXPECT_TRUE(take_spread_as_seen(problem, point).empty());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].sd, before[i]);
}

// The age of samples must not count as an offset that all trials share: it is expected to be equal in all
// trials.
TEST(DiagnoseAnotherProgram, TheAgeOfSamplesDoesNotLean) {
  const auto prepared = prepare(few_hops());
  const auto& problem = prepared.problem;
  const auto& first = problem.trials.front()->trial_nuisances;
  Point point = null_point(problem);
  for (std::size_t i = 0; i < first.size(); ++i)
    if (first[i].name.ends_with("sample_age_share"))
      for (auto& own : point.nuisances) own[i] = 3.0 * first[i].sd;
  EXPECT_EQ(largest_common_shift(problem, point).z, 0.0);
}

}  // namespace
}  // namespace sandhopper::diagnose
