#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/model/signal.hpp"
#include "tools/diagnose/plants/rotary_axis/nearby_sine.hpp"

namespace sandhopper::diagnose {
namespace {

// The simulated axis follows the recorded torque with its noise. White noise of 0.1 N m at 250 Hz moves 0.1
// kg m^2 within half a second by several times the encoder's noise.
TEST(DiagnoseRotary, NoiseOfTheTorquesSensorIsNoErrorOfTheAngle) {
  constexpr double kNoise_Nm = 0.1;
  auto recordings = swings([](double, double, double) { return 0.0; }, 1, 8);
  recordings.belief.numbers["sensors.torque_noise_Nm"] = kNoise_Nm;
  for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
    recordings.beliefs[i] = recordings.belief;
    Random random(7, i);
    for (double& torque : recordings.trials[i].channels["torque_Nm"]) torque += kNoise_Nm * random.normal();
  }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::consistent);
  const auto angle =
      std::ranges::find_if(d.fits, [](const ChannelFit& fit) { return fit.channel == "position_rad"; });
  ASSERT_NE(angle, d.fits.end());
  EXPECT_LT(angle->floor, 6e-4);
  EXPECT_LT(angle->heldout.after, 1.2 * angle->floor);
}

// A drive that is off makes no torque; its torque sensor has an offset that the belief does not state.
TEST(DiagnoseRotary, AZeroOfTheTorqueThatNobodyStatedIsNoTorque) {
  auto recordings = swings([](double, double, double torque_Nm) { return -torque_Nm; }, 4, 6);
  recordings.belief.numbers["sensors.torque_noise_Nm"] = 0.03;
  for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
    recordings.beliefs[i] = recordings.belief;
    Random random(8, i);
    const double zero_Nm = 0.025 * random.normal();
    for (double& torque : recordings.trials[i].channels["torque_Nm"])
      torque = zero_Nm + 0.03 * random.normal();
  }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::consistent);
  for (const auto& fit : d.fits) EXPECT_LT(fit.heldout.before, 1.2 * fit.floor) << fit.channel;
}

// A simulated motion begins at the encoder's reading. So in every trial an encoder offset equals another rest
// angle of the arm.
TEST(DiagnoseRotary, NoTrialTellsAnEncoderThatIsOffFromAnArmThatHangsElsewhere) {
  auto recordings = swings([](double, double, double) { return 0.0; }, 2, 6);
  for (auto& trial : recordings.trials)
    for (double& angle : trial.channels["position_rad"]) angle += 0.03;
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.effects.size(), 1u);
  std::vector<std::string> names = d.effects.front().indistinguishable_from;
  names.push_back(d.effects.front().id);
  for (const char* id : {"axis.offset", "encoder.offset"})
    EXPECT_NE(std::ranges::find(names, id), names.end()) << id;
  EXPECT_TRUE(d.next.setup.empty()) << d.next.why;
}

// A fast clock on each channel in turn: 50 ms off after 2.5 s, six times the lead-in of a block.
TEST(DiagnoseRotary, AClockThatRunsFastIsFoundOnItsChannelAndAlone) {
  constexpr double kDrift = 0.02;
  for (const char* channel : {"position_rad", "velocity_radps", "torque_Nm"}) {
    auto recordings = swings([](double, double, double) { return 0.0; }, 3, 6);
    for (auto& trial : recordings.trials) {
      auto& values = trial.channels[channel];
      const double step_s = trial.time_s[1] - trial.time_s[0];
      const Signal shown{trial.time_s.front(), step_s, values};
      for (std::size_t i = 0; i < values.size(); ++i) values[i] = shown.at(trial.time_s[i] / (1.0 + kDrift));
    }
    const auto d = diagnose(recordings);
    ASSERT_EQ(d.effects.size(), 1u) << channel;
    const auto& found = d.effects.front();
    EXPECT_EQ(found.id, "clock.drift");
    EXPECT_EQ(found.channel, channel);
    EXPECT_GT(found.probability, 0.8) << channel;
    EXPECT_LE(found.parameters.front().low, kDrift) << channel;
    EXPECT_GE(found.parameters.front().high, kDrift) << channel;
    for (const auto& fit : d.fits)
      EXPECT_LE(fit.heldout.after, 1.2 * fit.floor) << channel << ' ' << fit.channel;
  }
}

// If inertia, gravity and torque are smaller by one factor, a frictionless axis moves as before. The
// uncertainties of the torque sensor must scale as well.
TEST(DiagnoseRotary, ATorqueThatActsInPartIsAsUnsureInThatPart) {
  constexpr double kPart = 0.4;
  auto recordings = swings([](double, double, double) { return 0.0; }, 4, 1);
  recordings.belief.numbers["sensors.torque_noise_Nm"] = 0.1;
  std::string why;
  const auto trial = make_plant(PlantKind::rotary_axis)->trial(recordings.trials[0], recordings.belief, why);
  ASSERT_NE(trial, nullptr) << why;
  Edits in_part;
  in_part.scale("axis.inertia_kg_m2", kPart);
  in_part.scale("axis.gravity_torque_Nm", kPart);
  in_part.sensor("actuator", SensorEdit::Kind::gain, kPart);
  std::vector<double> nuisances;
  nuisances.resize(trial->trial_nuisances.size(), 0.0);
  for (std::uint32_t b = 0; b < trial->blocks; ++b)
    for (const auto& nuisance : trial->block_nuisances)
      nuisances.push_back(nuisance.name.starts_with("torque") ? nuisance.sd : 0.0);
  const std::vector<double> as_believed(trial->nuisance_count(), 0.0);
  std::vector<double> still(trial->rows.size()), all(still), part(still);
  trial->predict({}, as_believed, still);
  trial->predict({}, nuisances, all);
  trial->predict(in_part, nuisances, part);
  double moved = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    moved = std::max(moved, std::abs(all[k] - still[k]));
    ASSERT_NEAR(part[k], all[k], 1e-9) << k;
  }
  EXPECT_GT(moved, 1e-3);
}

// A hand that pushes once in one trial has more effect than all friction.
TEST(DiagnoseRotary, WhatHappensOnceIsToldAndLeftOut) {
  constexpr long kSteps = 125000, kTrial = 3, kFrom = 70000, kTo = 75000;  // in steps of 20 us
  constexpr double kCoulomb_Nm = 0.1, kPush_Nm = 20.0;
  long step = 0;
  const auto d = diagnose(swings(
      [&](double, double speed, double) {
        const long trial = step / kSteps, at = step++ % kSteps;
        return (trial == kTrial && at > kFrom && at < kTo ? kPush_Nm : 0.0) -
               kCoulomb_Nm * std::tanh(speed / 0.02);
      },
      6, 12));
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "axis.coulomb");
  EXPECT_LE(d.effects.front().parameters.front().low, kCoulomb_Nm);
  EXPECT_GE(d.effects.front().parameters.front().high, kCoulomb_Nm);
  const auto told = std::ranges::count_if(
      d.notes, [](const auto& note) { return note.starts_with("4: something happened once"); });
  EXPECT_EQ(told, 1);
}

// Linear interpolation between 200 rows per second reduces the peaks of a torque of 4 Hz by (2 pi 4 / 200)^2
// / 12 = 0.13 %, and a torque that is held through a step by the same amount. Together this would look like a
// scale error of 0.25 %.
TEST(DiagnoseRotary, ATorqueInSlowRowsIsAsLargeAsItIsBetweenThem) {
  constexpr double kRate_radps = 2.0 * M_PI * 4.0, kAmplitude_rad = 0.3, kRow_s = 5e-3, kInertia_kg_m2 = 0.1;
  Belief belief;
  belief.numbers = {{"axis.inertia_kg_m2", kInertia_kg_m2},
                    {"axis.gravity_torque_Nm", 0.0},
                    {"axis.friction_switch_speed_radps", 0.02},
                    {"sensors.position_noise_rad", 5e-4},
                    {"sensors.velocity_noise_radps", 0.02}};
  Trial swing;
  swing.name = "1";
  swing.kind = "motion";
  for (int i = 0; i < 500; ++i) {
    const double t = kRow_s * i, angle = kAmplitude_rad * std::sin(kRate_radps * t);
    swing.time_s.push_back(t);
    swing.channels["position_rad"].push_back(angle);
    swing.channels["velocity_radps"].push_back(kAmplitude_rad * kRate_radps * std::cos(kRate_radps * t));
    swing.channels["torque_Nm"].push_back(-kInertia_kg_m2 * kRate_radps * kRate_radps * angle);
  }
  std::string why;
  const auto trial = make_plant(PlantKind::rotary_axis)->trial(swing, belief, why);
  ASSERT_NE(trial, nullptr) << why;
  std::vector<double> out(trial->rows.size());
  trial->predict({}, std::vector<double>(trial->nuisance_count(), 0.0), out);
  // Fits the error of each block with a constant, a drift and a share of the motion. The share must be 0.
  for (std::uint32_t b = 0; b < trial->blocks; ++b) {
    std::vector<Eigen::Vector3d> columns;
    std::vector<double> short_by;
    for (std::size_t i = 0; i < trial->rows.size(); ++i) {
      const auto& row = trial->rows[i];
      if (row.block != b || row.channel != 0) continue;
      columns.emplace_back(1.0, row.time_s, row.measured);
      short_by.push_back(row.measured - out[i]);
    }
    if (columns.size() < 60) continue;  // more than half a swing
    Eigen::MatrixXd a(columns.size(), 3);
    for (std::size_t i = 0; i < columns.size(); ++i) a.row(static_cast<Eigen::Index>(i)) = columns[i];
    const Eigen::Vector3d share =
        a.colPivHouseholderQr().solve(Eigen::Map<Eigen::VectorXd>(short_by.data(), a.rows()));
    EXPECT_NEAR(share[2], 0.0, 2e-4) << "stretch " << b;
  }
}

TEST(DiagnoseRotary, ANearbySineIsTheSine) {
  for (const double at : {-3.0, -0.4, 0.0, 1.5, 40.0})
    for (double d = -0.3; d <= 0.3; d += 1e-3)
      EXPECT_NEAR(NearbySine(at)(at + d), std::sin(at + d), 2e-9) << at;
}

// In three clamped trials torque moves nothing. They carry no information on the axis and must be left out by
// name.
TEST(DiagnoseRotary, AClampedAxisIsNoAxisThatDoesNotFollow) {
  auto recordings = swings([](double, double, double) { return 0.0; });
  for (std::size_t i = 0; i < 3; ++i) {
    Random random(7, i);
    Trial clamped = recordings.trials[i];
    clamped.name += " clamped";
    clamped.kind = "clamped";
    for (double& angle : clamped.channels["position_rad"]) angle = 5e-4 * random.normal();
    for (double& speed : clamped.channels["velocity_radps"]) speed = 0.02 * random.normal();
    recordings.trials.push_back(std::move(clamped));
    recordings.beliefs.push_back(recordings.belief);
  }
  const auto prepared = prepare(recordings);
  EXPECT_EQ(prepared.problem.trials.size(), recordings.trials.size() - 3);
  ASSERT_EQ(prepared.left_out.size(), 3u);
  EXPECT_NE(prepared.left_out.front().find("clamped"), std::string::npos);
  EXPECT_EQ(diagnose(recordings).verdict, Verdict::consistent);
}

// Without an encoder the trial begins at the angle of its set-up, where gravity is known. For an axis at rest
// a torque that reads 2.0 / 2.6 of its true value explains the same data.
TEST(DiagnoseRotary, WithoutAPositionATrialBeginsWhereItsSetUpSays) {
  for (const double gravity_Nm : {2.0, 2.6}) {  // the belief is 2.0
    auto recordings = swings([](double, double, double) { return 0.0; }, 1, 8);
    for (std::size_t i = 0; i < recordings.trials.size(); ++i) {
      Random random(9, i);
      auto& trial = recordings.trials[i];
      const double angle = 0.3 + 0.1 * static_cast<double>(i);
      trial.kind = "hold";
      trial.setup["position_rad"] = angle;
      trial.channels.erase("position_rad");
      for (double& speed : trial.channels["velocity_radps"]) speed = 0.02 * random.normal();
      for (double& torque : trial.channels["torque_Nm"])
        torque = gravity_Nm * std::sin(angle) + 1e-3 * random.normal();
    }
    const auto d = diagnose(recordings);
    if (gravity_Nm == 2.0) {
      EXPECT_EQ(d.verdict, Verdict::consistent);
      continue;
    }
    ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
    const auto& found = d.effects.front();
    const std::string other = found.id == "axis.gravity" ? "axis.torque_scale" : "axis.gravity";
    EXPECT_THAT(found.indistinguishable_from, ::testing::Contains(other)) << found.id;
    if (found.id == "axis.gravity")
      EXPECT_NEAR(found.parameters.front().value, 2.6 / 2.0 - 1.0, 0.05) << found.parameters.front().name;
    else
      EXPECT_NEAR(found.parameters.front().value, 2.0 / 2.6 - 1.0, 0.02) << found.id;
  }
}

// The drive is off and gives no scale for the effects; gravity does.
TEST(DiagnoseRotary, APendulumThatSwingsFreeHasFrictionOfItsOwnSize) {
  constexpr double kInertia_kg_m2 = 0.1, kGravityTorque_Nm = 2.0, kViscous_Nm_s = 0.03, kStep_s = 2e-5;
  Recordings r = swings([](double, double, double) { return 0.0; });
  for (std::size_t i = 0; i < r.trials.size(); ++i) {
    Random random(3, i);
    Trial& trial = r.trials[i];
    double angle = 0.5 + 0.15 * static_cast<double>(i), speed = 0.0;
    std::size_t row = 0;
    for (long step = 0; row < trial.time_s.size(); ++step) {
      if (step % 200 == 0) {
        trial.channels["position_rad"][row] = angle + 5e-4 * random.normal();
        trial.channels["velocity_radps"][row] = speed + 0.02 * random.normal();
        trial.channels["torque_Nm"][row++] = 0.0;
      }
      speed -= kStep_s / kInertia_kg_m2 * (kGravityTorque_Nm * std::sin(angle) + kViscous_Nm_s * speed);
      angle += kStep_s * speed;
    }
  }
  const auto d = diagnose(r);
  const auto viscous = std::ranges::find(d.effects, "axis.viscous", &FoundEffect::id);
  ASSERT_NE(viscous, d.effects.end()) << to_text(d);
  EXPECT_GT(viscous->probability, 0.5);
  EXPECT_NEAR(viscous->parameters.front().value, kViscous_Nm_s, 0.1 * kViscous_Nm_s);
}

// A flywheel that coasts down; only its speed is recorded. Inertia times deceleration is the scale of its
// friction.
TEST(DiagnoseRotary, AWheelOfWhichOnlyTheSpeedIsRecordedHasFriction) {
  constexpr double kInertia_kg_m2 = 0.1, kViscous_Nm_s = 0.05;
  Recordings r = swings([](double, double, double) { return 0.0; }, 1, 6);
  r.belief.numbers["axis.gravity_torque_Nm"] = 0.0;
  r.beliefs.assign(r.trials.size(), r.belief);
  for (std::size_t i = 0; i < r.trials.size(); ++i) {
    Random random(5, i);
    Trial& trial = r.trials[i];
    trial.channels.erase("position_rad");
    const double start_radps = 10.0 + 2.0 * static_cast<double>(i);
    for (std::size_t row = 0; row < trial.time_s.size(); ++row) {
      trial.channels["velocity_radps"][row] =
          start_radps * std::exp(-kViscous_Nm_s / kInertia_kg_m2 * trial.time_s[row]) +
          0.02 * random.normal();
      trial.channels["torque_Nm"][row] = 0.0;
    }
  }
  const auto d = diagnose(r);
  const auto viscous = std::ranges::find(d.effects, "axis.viscous", &FoundEffect::id);
  ASSERT_NE(viscous, d.effects.end()) << to_text(d);
  EXPECT_GT(viscous->probability, 0.5);
  EXPECT_NEAR(viscous->parameters.front().value, kViscous_Nm_s, 0.03 * kViscous_Nm_s);
}

bool has_reading_of_torque(const Recordings& recordings) {
  const auto prepared = prepare(recordings);
  return std::ranges::any_of(prepared.problem.candidates,
                             [](const Candidate& c) { return c.channel == "torque_Nm"; });
}

TEST(DiagnoseRotary, ADriveThatIsOffHasNoTorqueThatReadsWrong) {
  Recordings r = swings([](double, double, double) { return 0.0; });
  EXPECT_TRUE(has_reading_of_torque(r));
  for (auto& trial : r.trials) std::ranges::fill(trial.channels["torque_Nm"], 0.0);
  EXPECT_FALSE(has_reading_of_torque(r));
}

// A motor with three slots and two poles has six periods of cogging in a turn; no motor has fewer.
TEST(DiagnoseRotary, FewerThanSixRipplesInATurnAreNoCogging) {
  const auto names_cogging = [](double periods) {
    const auto d =
        diagnose(swings([=](double angle, double, double) { return 0.2 * std::sin(periods * angle + 0.3); }));
    return std::ranges::any_of(d.effects, [](const FoundEffect& effect) {
      return effect.id == "joint.cogging" && effect.probability > 0.5;
    });
  };
  EXPECT_FALSE(names_cogging(4.0));
  EXPECT_TRUE(names_cogging(7.0));
}

// A pendulum that swings free, 0.5 m long, of which five things are not as believed.
Recordings with_five_things_wrong(double viscous_Nm_s, double coulomb_Nm) {
  constexpr double kInertia_kg_m2 = 0.1, kGravityTorque_Nm = 2.3, kStep_s = 2e-5;
  constexpr double kZero_rad = 0.05;
  constexpr std::size_t kLateRows = 4;
  Recordings r = swings([](double, double, double) { return 0.0; }, 1, 4);
  for (std::size_t i = 0; i < r.trials.size(); ++i) {
    Random random(3, i);
    Trial& trial = r.trials[i];
    auto& velocity = trial.channels["velocity_radps"];
    double angle = 0.5 + 0.3 * static_cast<double>(i), speed = 0.0;
    std::vector<double> speeds;
    for (long step = 0; speeds.size() < trial.time_s.size(); ++step) {
      if (step % 200 == 0) {
        const std::size_t row = speeds.size();
        speeds.push_back(speed);
        trial.channels["position_rad"][row] = angle + kZero_rad + 5e-4 * random.normal();
        velocity[row] = speeds[row < kLateRows ? 0 : row - kLateRows] + 0.02 * random.normal();
        trial.channels["torque_Nm"][row] = 0.0;
      }
      const double friction_Nm = viscous_Nm_s * speed + coulomb_Nm * std::tanh(speed / 0.02);
      speed -= kStep_s / kInertia_kg_m2 * (kGravityTorque_Nm * std::sin(angle) + friction_Nm);
      angle += kStep_s * speed;
    }
  }
  return r;
}

TEST(DiagnoseRotary, WhatIsLeftIsOfferedToMoreEffectsBeforeItIsUnknown) {
  const auto d = diagnose(with_five_things_wrong(0.03, 0.02));
  const auto value_of = [&](const char* id) {
    const auto it = std::ranges::find(d.effects, id, &FoundEffect::id);
    return it == d.effects.end() ? 0.0 : it->parameters.front().value;
  };
  // No torque is recorded, so only ratios to the inertia can be known.
  EXPECT_NEAR(value_of("axis.viscous") / value_of("axis.coulomb"), 1.5, 0.15) << to_text(d);
  EXPECT_EQ(d.effects.size(), 5u);
  EXPECT_TRUE(std::ranges::none_of(d.effects, &FoundEffect::is_unknown));
}

}  // namespace
}  // namespace sandhopper::diagnose
