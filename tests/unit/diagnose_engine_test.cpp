#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_json.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/answer/residuals_csv.hpp"

namespace sandhopper::diagnose {
namespace {

using ::testing::Contains;
using ::testing::DoubleNear;

double no_force(double, double, double) { return 0.0; }

const FoundEffect* effect(const Diagnosis& d, const std::string& id) {
  for (const auto& e : d.effects)
    if (e.id == id) return &e;
  return nullptr;
}

void expect_alone(const Diagnosis& d, const std::string& id, double low, double high) {
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1u);
  const auto& found = d.effects.front();
  EXPECT_EQ(found.id, id);
  EXPECT_GT(found.probability, 0.8);
  EXPECT_GE(found.parameters.front().value, low);
  EXPECT_LE(found.parameters.front().value, high);
  EXPECT_LE(d.fits.front().heldout.after, 1.1 * d.fits.front().floor);
  EXPECT_GT(d.fits.front().heldout.before, 1.5 * d.fits.front().floor);
}

TEST(Diagnose, FindsNothingWhereNothingIsMissing) {
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const auto d = diagnose(drops(no_force, seed));
    EXPECT_EQ(d.verdict, Verdict::consistent) << seed;
    EXPECT_TRUE(d.effects.empty());
    EXPECT_FALSE(d.absent.empty());
  }
}

TEST(Diagnose, FindsNothingOnAnAxisWhereNothingIsMissing) {
  const auto d = diagnose(swings([](double, double, double) { return 0.0; }));
  EXPECT_EQ(d.verdict, Verdict::consistent);
  EXPECT_TRUE(d.effects.empty());
}

// The drive is off: its torque channel is only noise and moves nothing.
TEST(Diagnose, NoiseOfATorqueThatIsOffIsNoTorque) {
  auto recordings = swings([](double, double, double torque) { return -torque; }, 3, 8);
  Random random(9, 0);
  for (auto& trial : recordings.trials)
    for (double& torque : trial.channels["torque_Nm"]) torque = 0.1 * random.normal();
  EXPECT_EQ(diagnose(recordings).verdict, Verdict::consistent);
}

TEST(Diagnose, NamesAirDragWithItsCoefficient) {
  // Drag with C_d 0.5, A = 0.01 m^2, 1.2 kg/m^3.
  const auto d =
      diagnose(drops([](double, double, double v) { return -0.5 * 1.2 * 0.01 * 0.5 * std::abs(v) * v; }));
  expect_alone(d, "air.quadratic_drag", 0.48, 0.52);
}

TEST(Diagnose, NamesLinearDragWithItsCoefficient) {
  const auto d = diagnose(drops([](double, double, double v) { return -0.01 * v; }));
  expect_alone(d, "air.linear_drag", 0.0096, 0.0104);
}

TEST(Diagnose, BlamesTheSensorForAFaultOfTheSensor) {
  expect_alone(diagnose(drops(no_force, 1, 8, 0.97)), "tof.scale", -0.032, -0.028);
}

TEST(Diagnose, NamesDryFrictionOfAnAxis) {
  const auto d = diagnose(swings([](double, double w, double) { return -0.1 * std::tanh(w / 0.01); }));
  expect_alone(d, "axis.coulomb", 0.095, 0.105);
}

// The name that was found may be wrong. So the upper bound of another effect is the size that it would have
// instead: dry friction of 0.1 N m at speeds of 2 rad/s and more equals viscous friction of up to 0.05 N m s.
TEST(Diagnose, BoundsAnEffectByItsSizeInPlaceOfWhatWasFound) {
  const auto d = diagnose(swings([](double, double w, double) { return -0.1 * std::tanh(w / 0.01); }));
  const auto viscous = std::ranges::find(d.absent, "axis.viscous", &Bound::id);
  ASSERT_NE(viscous, d.absent.end());
  EXPECT_GT(viscous->value, 0.02);
  EXPECT_LT(viscous->value, 0.2);
}

TEST(Diagnose, NamesViscousFrictionOfAnAxis) {
  const auto d = diagnose(swings([](double, double w, double) { return -0.03 * w; }));
  expect_alone(d, "axis.viscous", 0.029, 0.031);
}

TEST(Diagnose, NamesATorqueScale) {
  const auto d = diagnose(swings([](double, double, double torque) { return 0.06 * torque; }));
  expect_alone(d, "axis.torque_scale", 0.055, 0.065);
}

// Torques of up to 2 N m; from 1 N m on a fifth is lost.
TEST(Diagnose, NamesASaturationAndTheTorqueWhereItEnds) {
  const auto d = diagnose(
      swings([](double, double, double torque) { return -0.2 * std::min(1.0, torque * torque) * torque; }));
  expect_alone(d, "actuator.saturation", 0.18, 0.22);
  const auto& parameters = d.effects.front().parameters;
  ASSERT_EQ(parameters.size(), 2u);
  EXPECT_EQ(parameters[1].name, "reference_Nm");
  EXPECT_NEAR(parameters[1].value, 1.0, 0.1);
}

// A drive filters its speed once per row. The remaining half row must be named neither a delay nor an
// advance.
TEST(Diagnose, ALowPassThatRunsOnceARowIsNoSkew) {
  constexpr double kBandwidth_Hz = 20.0;
  auto recordings = swings([](double, double, double) { return 0.0; }, 1, 8);
  recordings.belief.numbers["sensors.encoder_velocity_bandwidth_Hz"] = kBandwidth_Hz;
  for (auto& belief : recordings.beliefs) belief = recordings.belief;
  for (auto& trial : recordings.trials) {
    const double row_s = trial.time_s[1] - trial.time_s[0];
    const double keep = std::exp(-2.0 * std::numbers::pi * kBandwidth_Hz * row_s);
    auto& velocity = trial.channels["velocity_radps"];
    double filtered = velocity.front();
    for (std::size_t i = 1; i < velocity.size(); ++i) {
      filtered = keep * filtered + (1.0 - keep) * velocity[i];
      velocity[i] = filtered;
    }
  }
  EXPECT_EQ(diagnose(recordings).verdict, Verdict::consistent);
}

// An axis is simulated in blocks. At the start of a block a late reading shows the motion of the block
// before.
TEST(Diagnose, ALateReadingOfAnAxisShowsWhatWasBeforeAStretch) {
  const auto recordings = swings([](double, double, double) { return 0.0; }, 1, 1);
  std::string why;
  const auto trial = make_plant(PlantKind::rotary_axis)->trial(recordings.trials[0], recordings.belief, why);
  ASSERT_NE(trial, nullptr) << why;
  const auto rows = trial->rows.size(), half = rows / 2;  // first half: positions; second half: velocities
  const double late_s = trial->rows[1].time_s - trial->rows[0].time_s;
  Edits edits;
  edits.sensor("position_rad", SensorEdit::Kind::delay_s, late_s);
  std::vector<double> nuisances(trial->nuisance_count(), 0.0), on_time(rows), late(rows);
  trial->predict({}, nuisances, on_time);
  trial->predict(edits, nuisances, late);
  const double read_noise_rad = 5e-4;
  std::size_t stretches = 0;
  double swiftest = 0.0;
  for (std::size_t k = 1; k < half; ++k) {
    if (trial->rows[k].block == trial->rows[k - 1].block) continue;
    ASSERT_EQ(trial->rows[half + k].time_s, trial->rows[k].time_s);
    const double speed = on_time[half + k];
    // the block begins at the angle that was read
    EXPECT_NEAR(late[k], on_time[k], 3.0 * read_noise_rad) << k;
    EXPECT_NEAR(late[k + 1] - late[k], late_s * speed, 3e-4) << k;  // and then follows with the delay
    swiftest = std::max(swiftest, late_s * std::abs(speed));
    ++stretches;
  }
  EXPECT_GE(stretches, 3u);
  EXPECT_GT(swiftest, 3e-3);
}

TEST(Diagnose, StatesTheClassWhereAConstantForceHasTwoExplanations) {
  // A constant share of the weight: buoyancy, or added mass of the fluid.
  const auto d = diagnose(drops([](double, double, double) { return 0.05 * 0.2 * 9.81; }));
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  EXPECT_EQ(d.detail, Detail::one_of_class);
  ASSERT_EQ(d.effects.size(), 1u);
  const auto& found = d.effects.front();
  auto named = found.indistinguishable_from;
  named.push_back(found.id);
  EXPECT_THAT(named, Contains("fluid.buoyancy"));
  EXPECT_THAT(named, Contains("fluid.added_mass"));
}

TEST(Diagnose, SaysUnknownAtThePortWhereNothingOnTheListFits) {
  // A tether that becomes tight below 3.5 m.
  const auto d = diagnose(
      drops([](double, double h, double) { return 0.4 * std::max(0.0, 3.5 - h) * (h < 3.0 ? 1.0 : 0.0); }));
  EXPECT_EQ(d.verdict, Verdict::unknown_physics) << to_text(d) << ::testing::PrintToString(d.log);
  EXPECT_NE(effect(d, "unknown@body"), nullptr);
  ASSERT_FALSE(d.unknown.empty());
  EXPECT_EQ(d.unknown.front().curve.variable, "height_m");
}

TEST(Diagnose, ANameThatClosesTheGapStaysWhereAnAccelerometerIsFarNoisierThanItsSensor) {
  // The body tumbles: this adds a slowly varying part to the accelerometer, twenty times the sensor's noise.
  constexpr double kTumbles_mps2 = 1.0, kStays = 0.998;
  auto recordings = drops([](double, double, double v) { return -0.01 * std::abs(v) * v; });
  for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
    Random random(5, i);
    double tumbling = 0.0;
    for (double& accel : recordings.trials[i].channels["accel_mps2"]) {
      tumbling = kStays * tumbling + std::sqrt(1.0 - kStays * kStays) * random.normal();
      accel += kTumbles_mps2 * tumbling;
    }
  }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::missing_physics) << to_text(d) << ::testing::PrintToString(d.log);
  EXPECT_NE(effect(d, "air.quadratic_drag"), nullptr) << to_text(d);
  EXPECT_GT(d.gap_closed, 0.9);
}

TEST(Diagnose, ANameThatClosesMostOfTheGapStaysWhateverIsLeft) {
  // Drag, and a much weaker spring that begins at 3 m and is on no list.
  const auto d = diagnose(drops(
      [](double, double h, double v) { return -0.03 * std::abs(v) * v + 0.1 * std::max(0.0, 3.0 - h); }));
  EXPECT_EQ(d.verdict, Verdict::missing_physics) << to_text(d);
  const auto* drag = effect(d, "air.quadratic_drag");
  ASSERT_NE(drag, nullptr) << to_text(d);
  EXPECT_GT(drag->probability, 0.5);
  EXPECT_GT(d.gap_closed, 0.5);
  EXPECT_LT(d.gap_closed, 1.0);
  for (const auto& found : d.effects) {
    if (found.is_unknown()) {
      EXPECT_LE(found.probability, 0.5);
    }
  }
}

TEST(Diagnose, ABedThatRemembersTheTouchIsUnknownAtTheGround) {
  // The bed is softer after touchdown: by half at first, decaying with a time constant of 50 ms.
  const auto d = diagnose(presses([](double, double) { return 0.0; }, 1, 8,
                                  [](double since_s) { return -0.5 * std::exp(-since_s / 0.05); }));
  EXPECT_EQ(d.verdict, Verdict::unknown_physics) << to_text(d) << ::testing::PrintToString(d.log);
  EXPECT_NE(effect(d, "unknown@ground"), nullptr);
  ASSERT_FALSE(d.unknown.empty());
  EXPECT_EQ(d.unknown.front().curve.variable, "time since touchdown, s, times the quasi-static force");
}

TEST(Diagnose, NamesAStuckSensorAndIsNotMisledByIt) {
  auto recordings = drops(no_force);
  for (auto& trial : recordings.trials) {
    auto& accel = trial.channels["accel_mps2"];
    for (std::size_t i = 40; i < 60; ++i) accel[i] = accel[40];
  }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.detail, Detail::data_fault);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "data.stuck");
  EXPECT_EQ(d.effects.front().channel, "accel_mps2");
}

TEST(Diagnose, DoesNotDependOnTheOrderOfTrials) {
  auto recordings = drops([](double, double, double v) { return -0.003 * std::abs(v) * v; });
  const auto first = diagnose(recordings);
  std::reverse(recordings.trials.begin(), recordings.trials.end());
  const auto second = diagnose(recordings);
  ASSERT_EQ(first.effects.size(), 1u);
  ASSERT_EQ(second.effects.size(), 1u);
  EXPECT_EQ(first.effects.front().id, second.effects.front().id);
  EXPECT_THAT(first.effects.front().parameters.front().value,
              DoubleNear(second.effects.front().parameters.front().value, 1e-3));
}

TEST(Diagnose, SaysTooLittleDataWhereOneTrialShowsNothing) {
  const auto d = diagnose(drops(no_force, 1, 1));
  EXPECT_EQ(d.verdict, Verdict::insufficient_data);
  EXPECT_EQ(d.detail, Detail::too_little_data);
}

TEST(Diagnose, TellsWhatAMissingChannelRulesOut) {
  auto recordings = drops(no_force);
  for (auto& trial : recordings.trials) trial.channels.erase("accel_mps2");
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::consistent);
  EXPECT_THAT(d.notes, Contains(::testing::HasSubstr("accel_mps2")));
}

// The squares of the residual rows must sum to the errors that are reported by channel.
TEST(Diagnose, ItsResidualsAreTheErrorsItReports) {
  const auto d = diagnose(drops([](double, double, double v) { return -0.003 * std::abs(v) * v; }, 1, 6));
  const auto lines = residuals_csv(d);
  EXPECT_EQ(static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n')), d.residuals.size() + 1);
  ASSERT_FALSE(d.fits.empty());
  for (const auto& fit : d.fits) {
    double before = 0.0, after = 0.0, rows = 0.0;
    for (const auto& r : d.residuals)
      if (r.channel == fit.channel) {
        before += r.before * r.before;
        after += r.after * r.after;
        ++rows;
      }
    EXPECT_NEAR(std::sqrt(before / rows), fit.heldout.before, 1e-9) << fit.channel;
    EXPECT_NEAR(std::sqrt(after / rows), fit.heldout.after, 1e-9) << fit.channel;
  }
}

// True noise: 5e-4 rad.
TEST(DiagnoseNoise, ASensorThatIsWorseThanStatedIsReportedAndAStatedOneIsNot) {
  const auto none = [](double, double, double) { return 0.0; };
  auto recordings = swings(none);
  const auto of_position = [](const Diagnosis& d) {
    return *std::ranges::find(d.noise, "position_rad", &SensorNoise::channel);
  };
  const auto stated = of_position(diagnose(recordings));
  EXPECT_FALSE(stated.is_raised);
  EXPECT_NEAR(stated.times(), 1.0, 0.15);
  for (auto& belief : recordings.beliefs) belief.numbers["sensors.position_noise_rad"] = 2.5e-4;
  const auto d = diagnose(recordings);
  const auto noise = of_position(d);
  EXPECT_TRUE(noise.is_raised && noise.is_sensor_worse);
  EXPECT_NEAR(noise.times(), 2.0, 0.3);
  const auto json = to_json(d)["sensor_noise"][0];
  EXPECT_EQ(json["stated"], 2.5e-4);
  EXPECT_TRUE(json["raised"]);
}

// One trial of five whose encoder is six times as noisy as in the others.
TEST(DiagnoseNoise, ATrialThatCountsLessIsNamed) {
  const auto notes_of = [](double more_rad) {
    auto recordings = swings([](double, double, double) { return 0.0; });
    Random random(3, 0);
    for (double& q : recordings.trials.front().channels["position_rad"]) q += more_rad * random.normal();
    std::string text;
    for (const auto& note : diagnose(recordings).notes) text += note + "\n";
    return text;
  };
  EXPECT_NE(notes_of(3e-3).find(": position_rad is 6"), std::string::npos);
  EXPECT_EQ(notes_of(0.0).find("as noisy as"), std::string::npos);
}

// Friction that changes its sign at once, where the narrowest change that is looked for takes 0.008 rad/s.
TEST(DiagnoseLimits, AnEstimateAtTheEndOfItsRangeIsMarkedOnlyIfMoreMayLieBeyond) {
  const auto d = diagnose(swings([](double, double v, double) {
    return v > 0.0 ? -0.3 : v < 0.0 ? 0.3 : 0.0;
  }));
  ASSERT_FALSE(d.effects.empty());
  std::size_t marked = 0;
  for (const auto& p : d.effects.front().parameters) {
    EXPECT_NEAR(p.value, p.limit.value_or(p.value), 1e-6) << p.name;
    marked += p.limit.has_value();
  }
  EXPECT_EQ(d.effects.front().id, "axis.coulomb");
  EXPECT_EQ(marked, 1u);
  const EffectParameter share{.is_whole_range = true};
  EXPECT_TRUE(share.at_high(1.0) && share.at_low(0.0) && !share.at_low(0.5));
}

TEST(DiagnosisJson, HasEveryKeyOfTheContract) {
  const auto json =
      to_json(diagnose(drops([](double, double, double v) { return -0.003 * std::abs(v) * v; }, 1, 6)));
  for (const char* key : {"verdict", "detail", "noise_floor", "where", "effects", "fit", "next_trial"})
    EXPECT_TRUE(json.contains(key)) << key;
  ASSERT_FALSE(json["effects"].empty());
  const auto& effect = json["effects"][0];
  for (const char* key :
       {"id", "statement", "equation", "parameters", "probability", "heldout_gain", "indistinguishable_from"})
    EXPECT_TRUE(effect.contains(key)) << key;
  const auto parameter = effect["parameters"].begin().value();
  EXPECT_LE(parameter["ci95"][0].get<double>(), parameter["value"].get<double>());
  EXPECT_GE(parameter["ci95"][1].get<double>(), parameter["value"].get<double>());
  ASSERT_FALSE(json["where"].empty());
  for (const char* key :
       {"channel", "phase", "from_s", "to_s", "trials", "coordinate", "range", "share_of_excess", "p_value"})
    EXPECT_TRUE(json["where"][0].contains(key)) << key;
  EXPECT_TRUE(json["fit"]["heldout"].contains("floor"));
}

// The recordings show how far a number of the belief is off; its new value follows from that.
TEST(DiagnosisJson, GivesTheChangeOfANumberBeforeItsValue) {
  FoundEffect found;
  found.id = "foot.mass";
  found.parameters = {{"foot_mass_kg", 0.49, 0.48, 0.5},
                      {"foot_mass_change_kg", -0.04, -0.05, -0.03, true, true},
                      {"other_m", 1.0, 0.9, 1.1}};
  Diagnosis d;
  d.effects.push_back(found);
  std::vector<std::string> names;
  const auto json = to_json(d);
  for (const auto& [name, value] : json["effects"][0]["parameters"].items()) names.push_back(name);
  EXPECT_EQ(names, (std::vector<std::string>{"foot_mass_change_kg", "foot_mass_kg", "other_m"}));
}

}  // namespace
}  // namespace sandhopper::diagnose
