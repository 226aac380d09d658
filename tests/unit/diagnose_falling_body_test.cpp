#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/plants/falling_body/falling_body_recording.hpp"

namespace sandhopper::diagnose {
namespace {

std::size_t heights(const Problem& problem) {
  return static_cast<std::size_t>(
      std::ranges::count_if(problem.trials.front()->rows, [](const Row& row) { return row.channel == 0; }));
}

// The time of a sample is uncertain within its row, so a height near the ground may be one after landing: 30
// mm too high at 10 m/s.
TEST(DiagnoseFallingBody, WhereTheBodyMayHaveLandedNoHeightCounts) {
  auto recordings = drops([](double, double, double) { return 0.0; }, 1, 1);
  const std::size_t all = heights(prepare(recordings).problem);
  auto& height = recordings.trials.front().channels["height_m"];
  const auto last = std::find_if(height.rbegin(), height.rend(), [](double h) { return std::isfinite(h); });
  *last = 0.008;  // has 3 mm of noise
  EXPECT_EQ(heights(prepare(recordings).problem), all - 1);
  *last = 0.02;
  EXPECT_EQ(heights(prepare(recordings).problem), all);
  *last = 0.008;
  recordings.trials.front().setup.erase("release_height_m");  // heights above an unknown zero
  EXPECT_EQ(heights(prepare(recordings).problem), all);
}

// A body on the ground stays at height 0. If the heights go on below 0, it has not landed.
TEST(DiagnoseFallingBody, ABodyThatFallsOnBelowZeroHasNotLanded) {
  auto recordings = drops([](double, double, double) { return 0.0; }, 1, 1);
  const std::size_t all = heights(prepare(recordings).problem);
  auto& trial = recordings.trials.front();
  for (double& h : trial.channels["height_m"]) h -= 1.0;
  trial.setup["release_height_m"] -= 1.0;
  EXPECT_EQ(heights(prepare(recordings).problem), all);
  for (double& h : trial.channels["height_m"]) h = std::max(h, -0.02);
  EXPECT_LT(heights(prepare(recordings).problem), all);
}

// The heights read 60 mm too much and are constant at the end: the body lies on the ground. A slowly sinking
// body, or one that is sampled slowly, still moves.
TEST(DiagnoseFallingBody, HeightsThatStandStillAtTheEndAreTheGround) {
  constexpr double kNoise_m = 0.005;
  Random random(5, 0);
  Samples fall;
  for (int i = 0; i < 170; ++i) {
    const double t = 0.004 * i;
    fall.time_s.push_back(t);
    fall.value.push_back(0.06 + std::max(0.0, 2.1 - 4.905 * t * t) + kNoise_m * random.normal());
  }
  const double landed_s = std::sqrt(2.1 / 4.905);
  const auto last_s = landed_after_s(fall, kNoise_m);
  ASSERT_TRUE(last_s.has_value());
  EXPECT_LT(*last_s, landed_s);
  EXPECT_GT(*last_s, landed_s - 0.013);
  while (fall.time_s.back() > landed_s) fall.time_s.pop_back(), fall.value.pop_back();
  EXPECT_FALSE(landed_after_s(fall, kNoise_m).has_value());
  Samples sinks;
  for (int i = 0; i < 600; ++i) {
    sinks.time_s.push_back(0.004 * i);
    sinks.value.push_back(1.0 - 0.1 * sinks.time_s.back() + kNoise_m * random.normal());
  }
  EXPECT_FALSE(landed_after_s(sinks, kNoise_m).has_value());
}

// A sensor at 180 Hz in rows at 500 Hz: its samples are three or two rows apart and up to one row old.
TEST(DiagnoseFallingBody, HeightsOfAClockOfTheirOwnAreAsUnsureAsTheyAreFast) {
  auto recordings = drops([](double, double, double) { return 0.0; }, 1, 1);
  EXPECT_EQ(prepare(recordings).problem.trials.front()->rows.front().relative_sd, 1.0);
  auto& trial = recordings.trials.front();
  auto& height = trial.channels["height_m"];
  double next_s = 0.0;
  for (std::size_t i = 0; i < height.size(); ++i) {
    const double fallen_m = 4.905 * trial.time_s[i] * trial.time_s[i];
    height[i] = trial.time_s[i] >= next_s ? trial.setup["release_height_m"] - fallen_m : std::nan("");
    if (trial.time_s[i] >= next_s) next_s += 0.0125;
  }
  const Prepared prepared = prepare(recordings);
  const auto& rows = prepared.problem.trials.front()->rows;
  EXPECT_NEAR(rows.front().relative_sd, 1.0, 0.1);
  const auto last = std::find_if(rows.rbegin(), rows.rend(), [](const Row& row) { return row.channel == 0; });
  const double fell_mps = 9.81 * last->time_s;
  EXPECT_NEAR(last->relative_sd, fell_mps * 0.005 / std::sqrt(12.0) / 0.003, 0.1 * last->relative_sd);
}

// Samples of the impact were removed at the accelerometer's limit. The bed begins before this gap, even if a
// delayed height shows it only afterwards.
TEST(DiagnoseFallingBody, ABlowThatIsNotThereIsWhereTheBedBegan) {
  Samples accels;
  for (int i = 0; i < 200; ++i)
    if (i < 100 || i > 140) accels.time_s.push_back(0.001 * i), accels.value.push_back(i < 100 ? 0.0 : 9.8);
  const auto began_s = gap_around_s(accels, 0.112);
  ASSERT_TRUE(began_s.has_value());
  EXPECT_NEAR(*began_s, 0.099, 1e-9);
  EXPECT_FALSE(gap_around_s(accels, 0.19).has_value());  // a gap at another time
}

// A ball thrown upwards with an accelerometer only. The set-up gives the speed without its direction. If the
// air's drag is known, the directions differ in the recording; without drag they do not, and downward is
// assumed.
TEST(DiagnoseFallingBody, WithoutHeightsTheAirTellsAThrowUpwards) {
  const auto thrown = [](double drag_coefficient, double believed) {
    constexpr double kMass_kg = 0.045, kArea_m2 = 0.0113, kDensity = 1.2, kStep_s = 1e-4;
    Recordings r;
    r.plant = PlantKind::falling_body;
    r.belief.numbers = {{"gravity_mps2", 9.81},
                        {"body.mass_kg", kMass_kg},
                        {"body.frontal_area_m2", kArea_m2},
                        {"medium.density_kg_per_m3", kDensity},
                        {"medium.drag_coefficient", believed},
                        {"spread.release_speed_mps", 0.03},
                        {"sensors.accel_noise_mps2", 0.05}};
    for (std::size_t i = 0; i < 8; ++i) {
      Random random(3, i);
      Trial trial;
      trial.name = std::to_string(i + 1);
      trial.kind = "drop";
      trial.setup = {{"release_height_m", 0.8}, {"release_speed_mps", 2.0 + 0.25 * static_cast<double>(i)}};
      double h = 0.8, v = trial.setup.at("release_speed_mps");
      for (long step = 0; h > 0.0; ++step) {
        const double a = -0.5 * kDensity * kArea_m2 * drag_coefficient / kMass_kg * std::abs(v) * v;
        if (step % 20 == 0) {
          trial.time_s.push_back(kStep_s * static_cast<double>(step));
          trial.channels["accel_mps2"].push_back(a + 0.05 * random.normal());
        }
        h += kStep_s * (v + 0.5 * kStep_s * (a - 9.81));
        v += kStep_s * (a - 9.81);
      }
      r.trials.push_back(std::move(trial));
      r.beliefs.push_back(r.belief);
    }
    return r;
  };
  EXPECT_EQ(diagnose(thrown(0.5, 0.5)).verdict, Verdict::consistent);
  EXPECT_EQ(diagnose(thrown(0.0, 0.0)).verdict, Verdict::consistent);
  const auto more = diagnose(thrown(0.75, 0.5));
  ASSERT_EQ(more.verdict, Verdict::missing_physics);
  EXPECT_EQ(more.effects.front().id, "air.quadratic_drag");
}

// The typical drag is a tenth of the weight at the speed that the body reached. A sinking body is slower than
// in free fall.
TEST(DiagnoseFallingBody, WhatSinksIsNeverAsFastAsAFall) {
  const auto speed_mps = [](double drag_N_s_per_m) {
    const auto sinking = drops([=](double, double, double v) { return -drag_N_s_per_m * v; });
    return prepare(sinking).problem.context.facts.speed_mps;
  };
  EXPECT_NEAR(speed_mps(0.0), std::sqrt(2.0 * 9.81 * 7.0), 0.3);
  EXPECT_NEAR(speed_mps(1.0), 0.2 * 9.81, 0.1);
}

// The drag begins when the body opens, which is on no list. The heights alone fit a drag that is always
// there; the accelerometer shows the moment.
TEST(DiagnoseFallingBody, ABodyThatOpensHasADragAndNoFaultOfItsCamera) {
  auto recordings =
      drops([](double t_s, double, double v) { return t_s > 0.3 ? -0.006 * std::abs(v) * v : 0.0; }, 4);
  const auto with_accelerometer = diagnose(recordings);
  EXPECT_NE(with_accelerometer.verdict, Verdict::consistent);
  EXPECT_TRUE(std::ranges::any_of(with_accelerometer.effects, &FoundEffect::is_unknown))
      << to_text(with_accelerometer);
  for (auto& trial : recordings.trials) trial.channels.erase("accel_mps2");
  const auto heights_alone = diagnose(recordings);
  ASSERT_EQ(heights_alone.effects.size(), 1u) << to_text(heights_alone);
  EXPECT_EQ(heights_alone.effects.front().id, "air.quadratic_drag");
}

bool says_unknown(const Diagnosis& d) {
  return std::ranges::any_of(d.effects, [](const FoundEffect& e) { return e.id == "unknown@body"; });
}

// A small sensor fault beside a large law is answered as unknown if a free-form law in place of the fault
// explains more; otherwise as the fault.
TEST(DiagnoseFallingBody, AFaultThatOnlyMendsTheFormOfALawIsUnknown) {
  const auto drag = [](double factor_from_0_3_s) {
    return [=](double t_s, double, double v) {
      return -0.008 * (t_s > 0.3 ? factor_from_0_3_s : 1.0) * std::abs(v) * v;
    };
  };
  const auto opens = drops(drag(1.6), 5);
  auto drifts = drops(drag(1.0), 5);
  for (auto& trial : drifts.trials)
    for (double& t_s : trial.time_s) t_s *= 1.004;
  EXPECT_TRUE(says_unknown(diagnose(opens)));
  const auto d = diagnose(drifts);
  EXPECT_FALSE(says_unknown(d));
  for (const char* id : {"air.quadratic_drag", "clock.drift"})
    EXPECT_TRUE(std::ranges::any_of(d.effects, [&](const FoundEffect& e) { return e.id == id; })) << id;
}

// In a short fall of a heavy body the coefficient is badly determined. The typical size must still be a tenth
// of the weight.
TEST(DiagnoseFallingBody, ADragOfTheTypicalSizeIsFelt) {
  for (const double mass_kg : {0.2, 20.0}) {
    auto recordings = drops([](double, double, double) { return 0.0; }, 1, 2);
    recordings.belief.numbers["body.mass_kg"] = mass_kg;
    for (auto& belief : recordings.beliefs) belief = recordings.belief;
    const auto prepared = prepare(recordings);
    const auto& problem = prepared.problem;
    const auto drag = std::ranges::find_if(
        problem.candidates, [](const Candidate& c) { return c.effect->id == "air.quadratic_drag"; });
    ASSERT_NE(drag, problem.candidates.end());
    const double speed_mps = problem.context.facts.speed_mps;
    const double force_N = 0.5 * 1.2 * 0.01 * drag->parameters.front().typical * speed_mps * speed_mps;
    EXPECT_GE(force_N, 0.099 * mass_kg * 9.81);
    EXPECT_GE(drag->parameters.front().typical, 0.5);
  }
}

// A body that hardly sinks stays within the noise for as long as a body that is held.
TEST(DiagnoseFallingBody, ABodyThatSinksSlowlyWasNotHeld) {
  constexpr double kCarried = 0.9;  // of its weight
  auto recordings = drops([](double, double, double) { return kCarried * 0.2 * 9.81; });
  recordings.belief.numbers["medium.density_kg_per_m3"] = kCarried * 0.2 / 7e-4;
  recordings.belief.numbers["medium.buoyancy_factor"] = 1.0;
  recordings.belief.numbers["medium.drag_coefficient"] = 0.0;
  recordings.beliefs.assign(recordings.trials.size(), recordings.belief);
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::consistent);
  const auto problem = prepare(recordings).problem;
  for (const auto& trial : problem.trials)
    EXPECT_TRUE(std::ranges::none_of(trial->trial_nuisances,
                                     [](const Nuisance& n) { return n.name == "release_time_s"; }));
}

// Bodies of three masses in water: a balance that reads 5 % too little, or 10 g on each body that were not
// weighed.
TEST(DiagnoseFallingBody, WhatIsOnEveryBodyIsAMassAsABalanceThatIsOffIs) {
  constexpr double kVolume_m3 = 1e-4, kLightest_kg = 0.2, kMiddle_kg = 0.3;
  for (const bool in_proportion : {true, false}) {
    Recordings recordings;
    for (std::size_t i = 0; i < 9; ++i) {
      const double mass_kg = kLightest_kg * (1.0 + 0.5 * static_cast<double>(i % 3));
      const double is_kg = in_proportion ? 1.05 * mass_kg : mass_kg + 0.01;
      // `drops` divides by its own mass and knows neither the fluid nor these bodies.
      auto one = drops(
          [&](double, double, double v) {
            const double force_N =
                -is_kg * 9.81 + 1000.0 * kVolume_m3 * 9.81 - 0.5 * 1000.0 * 0.01 * 0.4 * v * std::abs(v);
            return 0.2 * (force_N / (is_kg + 500.0 * kVolume_m3) + 9.81);
          },
          40 + i, 1);
      auto& belief = one.belief.numbers;
      belief["medium.density_kg_per_m3"] = 1000.0;
      belief["medium.drag_coefficient"] = 0.4;
      belief["medium.buoyancy_factor"] = 1.0;
      belief["medium.added_mass_factor"] = 0.5;
      belief["body.volume_m3"] = kVolume_m3;
      belief["body.mass_kg"] = kLightest_kg;
      if (i == 0) {
        recordings.plant = one.plant;
        recordings.belief = one.belief;
      }
      belief["body.mass_kg"] = mass_kg;
      one.trials.front().name = std::to_string(i + 1);
      one.trials.front().setup["mass_kg"] = mass_kg;
      recordings.trials.push_back(one.trials.front());
      recordings.beliefs.push_back(one.belief);
    }
    const auto d = diagnose(recordings);
    ASSERT_EQ(d.effects.size(), 1u) << in_proportion;
    EXPECT_EQ(d.effects.front().id, "body.mass");
    EXPECT_NEAR(d.effects.front().parameters.front().value,
                in_proportion ? 1.05 * kMiddle_kg : kMiddle_kg + 0.01, 0.001);
    EXPECT_NEAR(d.effects.front().parameters.back().value, in_proportion ? 1.0 : 0.0, 0.2);
  }
}

// Beads that sink in oil at their terminal speed, which differs by 2 % from bead to bead. A bead without
// weight whose trials each have their own speed fits better than one drag for all, but its weight and the
// starts must be tuned for that.
TEST(DiagnoseFallingBody, ATerminalSpeedIsADragAndNoMissingWeight) {
  Recordings r = drops([](double, double, double) { return 0.0; }, 1, 6);
  auto& belief = r.belief.numbers;
  belief = {{"gravity_mps2", 9.81},
            {"body.mass_kg", 1e-4},
            {"body.frontal_area_m2", 2e-5},
            {"body.volume_m3", 5e-8},
            {"medium.density_kg_per_m3", 1000.0},
            {"medium.buoyancy_factor", 1.0},
            {"sensors.height_noise_m", 5e-4}};
  r.beliefs.assign(r.trials.size(), r.belief);
  for (std::size_t i = 0; i < r.trials.size(); ++i) {
    Random random(11, i);
    Trial trial;
    trial.name = std::to_string(i + 1);
    trial.kind = "drop";
    const double speed_mps = 0.025 * (1.0 + 0.02 * random.normal());
    for (int row = 0; row < 160; ++row) {
      trial.time_s.push_back(0.05 * row);
      trial.channels["height_m"].push_back(0.25 - speed_mps * trial.time_s.back() + 5e-4 * random.normal());
    }
    r.trials[i] = std::move(trial);
  }
  const auto d = diagnose(r);
  ASSERT_FALSE(d.effects.empty());
  const auto& found = d.effects.front();
  EXPECT_TRUE(found.id == "air.linear_drag" || found.id == "air.quadratic_drag") << to_text(d);
  EXPECT_THAT(found.indistinguishable_from, ::testing::Not(::testing::Contains("body.mass")));
  if (found.id != "air.linear_drag") return;
  EXPECT_NEAR(found.parameters.front().value, (1e-4 - 5e-5) * 9.81 / 0.025, 0.05 * 0.0196);
}

// A bead whose speed settles within 0.3 ms, recorded every 50 ms: it falls at its terminal speed from the
// first row on.
TEST(DiagnoseFallingBody, ADragFarFasterThanTheRowsIsSimulated) {
  constexpr double kDrag_N_s_per_m = 0.04, kMass_kg = 1.2e-5;
  Recordings r = drops([](double, double, double) { return 0.0; }, 1, 1);
  r.belief.numbers = {{"gravity_mps2", 9.81},
                      {"body.mass_kg", kMass_kg},
                      {"medium.linear_drag_N_s_per_m", kDrag_N_s_per_m},
                      {"sensors.height_noise_m", 5e-4}};
  r.beliefs = {r.belief};
  Trial trial;
  trial.name = "1";
  trial.kind = "drop";
  const double terminal_mps = kMass_kg * 9.81 / kDrag_N_s_per_m;
  for (int row = 0; row < 100; ++row) {
    trial.time_s.push_back(0.05 * row);
    trial.channels["height_m"].push_back(0.25 - terminal_mps * trial.time_s.back());
  }
  r.trials = {trial};
  const auto prepared = prepare(r);
  ASSERT_EQ(prepared.problem.trials.size(), 1u);
  const TrialModel& model = *prepared.problem.trials.front();
  std::vector<double> out(model.rows.size());
  model.predict({}, std::vector<double>(model.nuisance_count(), 0.0), out);
  ASSERT_GT(out.size(), 90u);
  EXPECT_NEAR(out[50] - out[90], terminal_mps * (model.rows[90].time_s - model.rows[50].time_s),
              1e-4 * terminal_mps);
}

// Bodies of several sizes, each with its own believed drag, in a liquid that is less viscous than believed.
TEST(DiagnoseFallingBody, AnotherViscosityChangesTheDragOfEveryBodyByTheSameShare) {
  constexpr double kShare = 0.6;
  Recordings r = drops([](double, double, double) { return 0.0; });
  std::vector<double> believed;
  for (std::size_t i = 0; i < r.trials.size(); ++i) {
    believed.push_back(0.02 * std::pow(1.4, static_cast<double>(i)));
    r.trials[i] = drops([=](double, double, double v) { return -kShare * believed[i] * v; }).trials[i];
    r.beliefs[i].numbers["medium.linear_drag_N_s_per_m"] = believed[i];
  }
  const auto prepared = prepare(r);
  const auto drag = std::ranges::find(prepared.problem.candidates, "air.linear_drag", &Candidate::label);
  ASSERT_NE(drag, prepared.problem.candidates.end());
  Edits edits;
  const std::vector<double> change{(kShare - 1.0) * drag->parameters.front().base};
  drag->effect->apply(prepared.problem.context, "", change, edits);
  for (const double b : believed)
    EXPECT_NEAR(edits.edited("medium.linear_drag_N_s_per_m", b), kShare * b, 1e-12);
  // The same share of every mass fits as well.
  const auto d = diagnose(r);
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  const auto& found = d.effects.front();
  auto names = found.indistinguishable_from;
  names.push_back(found.id);
  EXPECT_THAT(names, ::testing::Contains("air.linear_drag")) << to_text(d);
}

}  // namespace
}  // namespace sandhopper::diagnose
