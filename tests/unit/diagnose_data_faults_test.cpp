#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"

// Data faults: contradictions that the recordings show without a simulation.
namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseDataFaults, SamplesThatFallToZeroAreADropoutAndNoPhysics) {
  auto recordings = drops([](double, double, double) { return -0.3; });
  for (auto& trial : recordings.trials)
    for (std::size_t i = 30; i + 3 < trial.channels["accel_mps2"].size(); i += 45)
      for (std::size_t k = 0; k < 3; ++k) trial.channels["accel_mps2"][i + k] = 0.0;
  const auto d = diagnose(recordings);
  const auto is = [](const char* id) { return [id](const FoundEffect& e) { return e.id == id; }; };
  const auto fault = std::find_if(d.effects.begin(), d.effects.end(), is("data.dropout"));
  ASSERT_NE(fault, d.effects.end());
  EXPECT_EQ(fault->channel, "accel_mps2");
  EXPECT_LE(fault->parameters.front().low, 0.015);
  EXPECT_GE(fault->parameters.front().high, 0.015);
}

// A dropout to 0 is invisible in samples where the quantity is near 0 itself. Such a stretch counts if other
// stretches of the same length fell to 0.
TEST(DiagnoseDataFaults, DropoutsAreCountedWhereTheQuantityIsNearZeroToo) {
  auto recordings = presses([](double, double) { return 0.0; });
  std::size_t lost = 0;
  double recorded_s = 0.0;
  for (auto& trial : recordings.trials) {
    auto& force = trial.channels["force_N"];
    recorded_s += trial.time_s.back() - trial.time_s.front();
    for (std::size_t i = 10; i + 5 < force.size(); i += 60, ++lost)
      for (std::size_t k = 0; k < 5; ++k) force[i + k] = 0.0;
  }
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "data.dropout");
  EXPECT_NEAR(d.effects.front().parameters.back().value, static_cast<double>(lost) / recorded_s,
              0.02 * static_cast<double>(lost) / recorded_s);
}

// The foot sinks meanwhile, so the force is small before the first of two stretches of zeros and large after
// it. The second one follows after two samples.
TEST(DiagnoseDataFaults, ADropoutRightBeforeAnotherIsOne) {
  std::vector<Trial> trials(6);
  for (std::size_t t = 0; t < trials.size(); ++t) {
    Random random(11, t);
    auto& force = trials[t].channels["force_N"];
    for (int i = 0; i < 400; ++i) {
      trials[t].time_s.push_back(0.001 * i);
      force.push_back(1e-3 * std::round(1e3 * (0.5 * std::max(0, i - 100) + 0.1 * random.normal())));
    }
    for (const std::ptrdiff_t first : {110, 122, 250, 330}) std::fill_n(force.begin() + first, 10, 0.0);
  }
  const auto faults = remove_data_faults(trials);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().id, "data.dropout");
  EXPECT_EQ(faults.front().stretches, 24u);
  for (const auto& trial : trials) EXPECT_TRUE(std::isnan(trial.channels.at("force_N")[115]));
}

// An accelerometer in free fall reads only its noise. Noise does not give the same value six times in a row.
TEST(DiagnoseDataFaults, DropoutsOfAChannelThatNeverLeavesZeroAreFound) {
  auto recordings = drops([](double, double, double) { return 0.0; });
  for (auto& trial : recordings.trials) {
    auto& accel = trial.channels["accel_mps2"];
    for (double& a : accel) a = 1e-3 * std::round(1e3 * a);
    for (std::size_t i = 30; i + 6 < accel.size(); i += 45)
      for (std::size_t k = 0; k < 6; ++k) accel[i + k] = 0.0;
  }
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "data.dropout");
  EXPECT_EQ(d.effects.front().channel, "accel_mps2");
}

// A torque in coarse steps repeats values where it changes slowly. A stretch without repeats around the
// tested one is chance.
TEST(DiagnoseDataFaults, WhatRepeatsElsewhereIsNotStuck) {
  auto trials = swings([](double, double, double) { return 0.0; }, 5, 4).trials;
  for (auto& trial : trials) {
    auto& torque = trial.channels["torque_Nm"];
    for (std::size_t i = 0; i < torque.size(); ++i)
      torque[i] = 0.01 * static_cast<double>(i / 2 % 40) - 0.5;  // every value twice
  }
  auto& torque = trials.front().channels["torque_Nm"];
  for (std::size_t i = 260; i < 310; ++i) torque[i] = 0.01 * static_cast<double>(i % 7 * 5) - 0.4;
  for (std::size_t i = 280; i < 290; ++i) torque[i] = -0.23;
  EXPECT_TRUE(remove_data_faults(trials).empty());
}

// Friction holds the axis: the encoder repeats one count, and the velocity is the noise of its converter,
// half a step low.
TEST(DiagnoseDataFaults, AnAxisThatStandsStillIsNotStuckButOneThatGoesOnIs) {
  for (const bool stands : {true, false}) {
    auto trials = swings([](double, double, double) { return 0.0; }, 5, 4).trials;
    auto& position = trials.front().channels["position_rad"];
    auto& velocity = trials.front().channels["velocity_radps"];
    Random random(11, 0);
    ASSERT_GT(position.size(), 400u);
    for (std::size_t i = 200; i < 280; ++i) {
      position[i] = position[200];
      if (stands) velocity[i] = 0.02 * std::floor(random.normal());
    }
    const auto faults = remove_data_faults(trials);
    EXPECT_EQ(faults.size(), stands ? 0u : 1u);
    if (!faults.empty()) {
      EXPECT_EQ(faults.front().id, "data.stuck");
      EXPECT_EQ(faults.front().channel, "position_rad");
    }
  }
}

// At a turning point an encoder shows one count for a while, and the velocity shows that the axis did not
// move on. If the axis moves on meanwhile, the encoder is stuck.
TEST(DiagnoseDataFaults, AnEncoderAtItsTurningPointIsNotStuck) {
  for (const bool turns : {true, false}) {
    constexpr double kCount_rad = 2e-3;
    Trial trial;
    trial.name = "1";
    for (std::size_t i = 0; i < 400; ++i) {
      const double t = 1e-3 * static_cast<double>(i);
      trial.time_s.push_back(t);
      trial.channels["motor_left_position_rad"].push_back(kCount_rad *
                                                          std::round(std::sin(20.0 * t) / kCount_rad));
      trial.channels["motor_left_velocity_radps"].push_back(20.0 * std::cos(20.0 * t));
    }
    auto& position = trial.channels["motor_left_position_rad"];
    if (!turns) std::fill(position.begin() + 300, position.begin() + 309, position[300]);
    std::vector<Trial> trials{trial};
    const auto faults = remove_data_faults(trials);
    EXPECT_EQ(faults.size(), turns ? 0u : 1u);
    EXPECT_EQ(std::ranges::all_of(trials.front().channels["motor_left_position_rad"],
                                  [](double v) { return std::isfinite(v); }),
              turns);
  }
}

// A joint that sticks comes to rest gradually and starts again with single counts. A stuck encoder jumps to
// the present position.
TEST(DiagnoseDataFaults, AJointThatSticksForAWhileIsNoStuckEncoder) {
  for (const bool sticks : {true, false}) {
    Trial trial;
    trial.name = "1";
    double counts = 0.0;
    for (int i = 0; i < 600; ++i) {
      const int since = i % 100 - 50;  // from the middle of a rest of nine rows
      const bool rests = std::abs(since) < 5;
      if (!rests) counts += std::min(40.0, 0.55 + std::pow(std::abs(since) - 5, 2) / 4.0);
      if (rests && !sticks) counts += 20.0;
      const bool held = rests && since > -4;
      trial.time_s.push_back(1e-3 * i);
      auto& position = trial.channels["position_rad"];
      position.push_back(held ? position.back() : 1e-6 * std::round(counts));
    }
    std::vector<Trial> trials{trial};
    EXPECT_EQ(remove_data_faults(trials).size(), sticks ? 0u : 1u);
  }
}

// A velocity that is computed from encoder counts is exactly 0 while no new count comes.
TEST(DiagnoseDataFaults, AnEncoderThatStandsWhileTheOtherMotorStandsIsNotStuck) {
  for (const bool both : {true, false}) {
    constexpr double kCount_rad = 4e-4;
    Trial trial;
    trial.name = "1";
    for (std::size_t i = 0; i < 400; ++i) {
      const double t = 1e-3 * static_cast<double>(i);
      trial.time_s.push_back(t);
      for (const char* side : {"left", "right"})
        trial.channels[std::string("motor_") + side + "_position_rad"].push_back(
            kCount_rad * std::round((t + 0.01 * std::sin(50.0 * t)) / kCount_rad));
    }
    auto& left = trial.channels["motor_left_position_rad"];
    auto& right = trial.channels["motor_right_position_rad"];
    std::fill(left.begin() + 300, left.begin() + 310, left[300]);
    if (both) std::fill(right.begin() + 300, right.begin() + 310, right[301]);
    std::vector<Trial> trials{trial};
    EXPECT_EQ(remove_data_faults(trials).size(), both ? 0u : 1u);
  }
}

// A single short repeat is no fault, so its samples must stay.
TEST(DiagnoseDataFaults, NothingIsTakenOutWhereNoFaultIsFound) {
  auto trials = drops([](double, double, double) { return 0.0; }).trials;
  auto& accel = trials.front().channels["accel_mps2"];
  std::fill(accel.begin() + 40, accel.begin() + 46, accel[40]);
  EXPECT_TRUE(remove_data_faults(trials).empty());
  EXPECT_TRUE(std::all_of(accel.begin(), accel.end(), [](double v) { return std::isfinite(v); }));
}

TEST(DiagnoseDataFaults, AnEncoderThatStandsStillIsNoDropout) {
  auto recordings = swings([](double, double, double) { return 0.0; });
  std::vector<Trial> trials = recordings.trials;
  for (auto& trial : trials) {
    auto& velocity = trial.channels["velocity_radps"];
    for (double& v : velocity) v = 1e-3 * std::round(1e3 * v);
    for (std::size_t i = 20; i + 5 < velocity.size(); i += 15)
      for (std::size_t k = 0; k < 5; ++k) velocity[i + k] *= std::abs(velocity[i]) < 0.15 ? 0.0 : 1.0;
  }
  for (const auto& fault : remove_data_faults(trials)) EXPECT_NE(fault.id, "data.dropout") << fault.channel;
}

TEST(DiagnoseDataFaults, AGapNowAndThenIsNoFinding) {
  auto recordings = drops([](double, double, double) { return 0.0; });
  for (std::size_t t = 0; t < recordings.trials.size(); t += 2) {
    auto& trial = recordings.trials[t];
    trial.time_s.erase(trial.time_s.begin() + 20, trial.time_s.begin() + 24);
    for (auto& [name, values] : trial.channels) values.erase(values.begin() + 20, values.begin() + 24);
  }
  EXPECT_EQ(diagnose(recordings).verdict, Verdict::consistent);
}

TEST(DiagnoseDataFaults, RowsThatAreLostAgainAndAgainAreADropout) {
  auto recordings = drops([](double, double, double) { return 0.0; });
  for (auto& trial : recordings.trials)
    for (std::size_t i = trial.time_s.size() - 8; i > 20; i -= 20) {
      const auto cut = [i](auto& values) {
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(i),
                     values.begin() + static_cast<std::ptrdiff_t>(i + 3));
      };
      cut(trial.time_s);
      for (auto& [name, values] : trial.channels) cut(values);
    }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.detail, Detail::data_fault);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "data.dropout");
}

// A drive that reports in coarse steps with little noise: the torque turns at zero within one step.
TEST(DiagnoseDataFaults, ATurnWithinOneStepOfTheGridIsNoDropout) {
  constexpr double kStep_Nm = 0.0088;
  std::vector<Trial> trials(3);
  for (std::size_t t = 0; t < trials.size(); ++t) {
    trials[t].name = std::to_string(t + 1);
    auto& torque = trials[t].channels["torque_Nm"];
    for (int i = 0; i < 3000; ++i) {
      trials[t].time_s.push_back(1e-3 * i);
      const double torque_Nm =
          0.012 + 0.0124 * std::sin(0.02 * i) + 0.1 * std::sin(0.0007 * i * static_cast<double>(t));
      torque.push_back(kStep_Nm * std::round(torque_Nm / kStep_Nm));
    }
  }
  for (const auto& fault : remove_data_faults(trials)) EXPECT_NE(fault.id, "data.dropout");
}

// A few missing rows of a hundred are usual and no fault.
TEST(DiagnoseDataFaults, FewRowsThatAreMissingAreNoFault) {
  auto recordings = drops([](double, double, double) { return 0.0; });
  for (auto& trial : recordings.trials)
    for (std::size_t i = trial.time_s.size() - 8; i > 50; i -= 50) {
      trial.time_s.erase(trial.time_s.begin() + static_cast<std::ptrdiff_t>(i));
      for (auto& [name, values] : trial.channels)
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
    }
  const auto d = diagnose(recordings);
  EXPECT_EQ(d.verdict, Verdict::consistent);
  EXPECT_TRUE(d.effects.empty());
}

// Removes the rows from `from` up to, but not including, `to`.
void lose_rows(Trial& trial, std::ptrdiff_t from, std::ptrdiff_t to) {
  const auto cut = [&](auto& values) { values.erase(values.begin() + from, values.begin() + to); };
  cut(trial.time_s);
  for (auto& [name, values] : trial.channels) cut(values);
}

TEST(DiagnoseDataFaults, GapsTwiceInHalfOfTheTrialsAreADropout) {
  auto recordings = drops([](double, double, double) { return 0.0; });
  for (std::size_t t = 0; t < recordings.trials.size(); t += 2) {
    lose_rows(recordings.trials[t], 40, 46);
    lose_rows(recordings.trials[t], 20, 26);
  }
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects.front().id, "data.dropout");
}

// A torque in coarse steps at a constant level repeats each of its values often, everywhere.
TEST(DiagnoseDataFaults, AValueThatOftenRepeatsIsNotStuck) {
  auto trials = swings([](double, double, double) { return 0.0; }, 5, 4).trials;
  for (auto& trial : trials) {
    auto& torque = trial.channels["torque_Nm"];
    for (std::size_t i = 0; i < torque.size(); ++i) torque[i] = 0.01 * static_cast<double>(115 + i % 10);
  }
  auto& torque = trials.front().channels["torque_Nm"];
  Random random(3, 0);
  for (std::size_t i = 20; i < 200; ++i) torque[i] = 0.01 * std::round(120.0 + 0.7 * random.normal());
  std::fill(torque.begin() + 260, torque.begin() + 269, 1.2);
  for (std::size_t i = 250; i < 280; ++i)
    if (i < 260 || i > 268) torque[i] = 1.18 + 0.01 * static_cast<double>(i % 5);
  EXPECT_TRUE(remove_data_faults(trials).empty());
}

// An axis that pauses starts again slowly. An encoder that was stuck jumps to another angle at once.
TEST(DiagnoseDataFaults, AQuietEncoderThatPausesIsNotStuck) {
  for (const bool pauses : {true, false}) {
    constexpr double kCount_rad = 2e-3;
    std::vector<Trial> trials;
    for (int n = 0; n < 2; ++n) {
      Trial trial;
      trial.name = std::to_string(n + 1);
      for (std::size_t i = 0; i < 400; ++i) {
        const double t = 5e-3 * static_cast<double>(i), since_s = t - 1.5 - 0.1 * n;
        const double going = 2.0 * std::sin(3.0 * t), goes_on = 400.0 * since_s * since_s;
        const double angle =
            pauses && t > 1.0 ? 2.0 * std::sin(3.0) + (since_s > 0.0 ? goes_on : 0.0) : going;
        trial.time_s.push_back(t);
        trial.channels["position_rad"].push_back(kCount_rad * std::round(angle / kCount_rad));
      }
      auto& position = trial.channels["position_rad"];
      if (!pauses) std::fill(position.begin() + 200, position.begin() + 230, position[200]);
      trials.push_back(std::move(trial));
    }
    EXPECT_EQ(remove_data_faults(trials).size(), pauses ? 0u : 1u);
  }
}

}  // namespace
}  // namespace sandhopper::diagnose
