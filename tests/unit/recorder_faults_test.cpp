#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "tests/unit/read_campaign.hpp"
#include "tools/campaign/lost_forces.hpp"

// Faults of a recorder that leave plausible numbers, each with sound recordings that look similar: a force
// that takes turns, a threshold, a held peak, bursts of times, uneven frames, folded angles.
namespace sandhopper {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kPress = "plant = \"intruder\"\n[every_trial]\nplate_diameter_m = 0.08\n";
const std::string kBody = "plant = \"falling_body\"\n";
const std::string kAxis = "plant = \"rotary_axis\"\n";

struct PressRow {
  int i;
  double depth_m, force_N;
};

// Down to 40 mm in 500 rows of 10 ms and up again, in a bed of 1500 N/m, with 0.15 N of noise in the force
// and 0.02 mm in the depth.
std::string press(
    const std::function<void(PressRow&)>& change = [](PressRow&) {}, bool withdraws = false) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < (withdraws ? 1000 : 500); ++i) {
    const double depth_m = i < 500 ? 1e-4 * (i - 100) : 1e-4 * (899 - i);
    const double unloaded_N = i < 500 ? 0.0 : 15000.0 * (0.0399 - depth_m);
    PressRow row{i, depth_m + 2e-5 * noise(random), 1500.0 * std::max(0.0, std::min(depth_m, 0.0399))};
    row.force_N = std::max(0.0, (i < 500 ? row.force_N : 59.85) - unloaded_N) + 0.15 * noise(random);
    change(row);
    text += fmt::format("{:.2f},{:.6f},{:.4f}\n", 0.01 * i, -row.depth_m, row.force_N);
  }
  return text;
}

TEST(AlternatingRows, TwoReadingsInOneColumnAreNamedWithACommand) {
  const auto told = read_campaign(kPress, press([](PressRow& row) {
                                    if (row.i % 2 == 1) row.force_N = 0.4 + 0.1 * std::sin(7.0 * row.i);
                                  }));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text,
              AllOf(HasSubstr("goes up and down in turns"), HasSubstr("awk 'NR < 2 || NR % 2 == 0'")));
}

TEST(AlternatingRows, HumAndHalvesThatGrowAlikeAreSound) {
  for (const double hum_N : {0.0, 0.5, 5.0}) {
    const auto told =
        read_campaign(kPress, press([&](PressRow& row) { row.force_N += row.i % 2 == 1 ? hum_N : -hum_N; }));
    EXPECT_THAT(told.text, Not(HasSubstr("in turns"))) << hum_N;
  }
}

TEST(ForceThreshold, ZerosBelowAThresholdAreToldAndLeftOut) {
  for (const bool flickers : {true, false}) {
    bool is_on = false;
    const auto told = read_campaign(kPress, press([&](PressRow& row) {
                                      is_on = row.force_N >= 10.0 || (is_on && !flickers);
                                      if (!is_on) row.force_N = 0.0;
                                    }));
    EXPECT_THAT(told.text, AllOf(HasSubstr("the recorder writes 0 below a threshold"), HasSubstr("6.")));
    EXPECT_THAT(told.text, Not(HasSubstr("comes back")));
    auto recording = told.recording;
    leave_out_lost_forces(recording);
    EXPECT_EQ(recording.channel("force_N")[50], 0.0) << "in air";
    EXPECT_TRUE(std::isnan(recording.channel("force_N")[130])) << "3 mm deep";
    EXPECT_FALSE(std::isnan(recording.channel("force_N")[200]));
  }
}

TEST(ForceThreshold, SoundForcesHaveNone) {
  const std::function<void(PressRow&)> sound[] = {
      [](PressRow&) {},
      [](PressRow& row) { row.force_N = std::max(0.0, row.force_N); },           // a display without a sign
      [](PressRow& row) { row.force_N = 5.0 * std::round(row.force_N / 5.0); },  // a coarse cell
      [](PressRow& row) { row.force_N = 1500.0 * std::max(0.0, row.depth_m); },  // a simulation without noise
      [](PressRow& row) {
        if (row.depth_m > 0.0) row.force_N += 10.0;
      },  // a crust at the surface
      [](PressRow& row) {
        if (row.depth_m < 0.007) row.force_N = 0.1 * std::sin(11.0 * row.i);
      }};  // a void
  for (std::size_t n = 0; n < std::size(sound); ++n)
    EXPECT_THAT(read_campaign(kPress, press(sound[n])).text, Not(HasSubstr("below a threshold"))) << n;
}

TEST(PeakHold, AForceThatNeverFallsIsNamedWithTheRowsOfThePush) {
  double most_N = -1e9;
  const auto held = press([&](PressRow& row) { row.force_N = most_N = std::max(most_N, row.force_N); }, true);
  const auto told = read_campaign(kPress, held);
  EXPECT_THAT(told.text, AllOf(HasSubstr("the gauge holds its peak"), HasSubstr("select = { to_line = 50")));
  EXPECT_THAT(told.text, Not(HasSubstr("stands still")));
  EXPECT_THAT(read_campaign(kPress, press([](PressRow&) {}, true)).text, Not(HasSubstr("peak")));
  EXPECT_THAT(
      read_campaign(kPress, press([](PressRow& row) { row.force_N = std::min(row.force_N, 50.0); }, true))
          .text,
      Not(HasSubstr("holds its peak")))
      << "a full cell";
}

TEST(EarlyEnd, AForceInKilonewtonsIsNamedBesideADepthListedFromTheTop) {
  const auto listed = [](double unit) {
    std::string text = "t_s,Depth (mm),force_N\n";
    for (int i = 0; i < 1000; ++i)
      text +=
          fmt::format("{:.3f},{},{:.6f}\n", 0.002 * i, i < 100 ? fmt::format("{:.4f}", 0.4 * i - 2.0) : "",
                      unit * (0.06 * i + 0.1 * std::sin(31.0 * i)));
    return text;
  };
  const auto head = kPress + "[columns]\nfoot_z_m = { column = \"Depth (mm)\", scale = -0.001 }\n";
  EXPECT_THAT(read_campaign(head, listed(0.001)).text,
              AllOf(HasSubstr("stands in each of the first"), HasSubstr("in another unit")));
  EXPECT_THAT(read_campaign(head, listed(1.0)).text, Not(HasSubstr("in another unit")));
}

TEST(BeginsInBed, AWholeFileThatBeginsLoadedAtDepthZeroIsNoted) {
  const auto from = [](double depth_m, double tare_N) {
    std::string text = "t_s,foot_z_m,force_N\n";
    for (int i = 0; i < 400; ++i)
      text += fmt::format("{:.2f},{:.6f},{:.4f}\n", 0.01 * i, -1e-4 * i,
                          1500.0 * (depth_m + 1e-4 * i) + tare_N + 0.15 * std::sin(57.0 * i * i));
    return text;
  };
  const auto told = read_campaign(kPress, from(0.02, 0.0));
  EXPECT_TRUE(told.recording.usable());
  EXPECT_THAT(told.text, AllOf(HasSubstr("in the first row, with 3"), HasSubstr("offset = -0.0")));
  EXPECT_THAT(read_campaign(kPress, from(0.0, 0.0)).text, Not(HasSubstr("in the first row")));
  EXPECT_THAT(read_campaign(kPress, from(0.0, 0.6)).text, Not(HasSubstr("in the first row")))
      << "a small preload";
}

TEST(SurfaceOnset, AForceThatIsHeldInAirDoesNotHideALateForce) {
  const auto late = press([](PressRow& row) {
    if (row.i < 40) row.force_N = 0.07;
    if (row.i >= 40)
      row.force_N = 1500.0 * std::max(0.0, row.depth_m - 0.006) + 0.1 * std::sin(57.0 * row.i * row.i);
  });
  EXPECT_THAT(read_campaign(kPress, late).text, HasSubstr("the force begins at a depth of"));
  const auto sound = press([](PressRow& row) {
    if (row.i < 40) row.force_N = 0.07;
  });
  EXPECT_THAT(read_campaign(kPress, sound).text, Not(HasSubstr("the force begins at a depth of")));
}

// A body that falls from 10 m, 120 heights a second with `noise_m`; `at_s` gives the true time of row i, and
// `written` changes its height.
std::string fall(
    double noise_m, const std::function<double(int)>& at_s = [](int i) { return i / 120.0; },
    const std::function<double(int)>& clock_s = [](int i) { return i / 120.0; }, int rows = 160) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, noise_m);
  std::string text = "t_s,height_m\n";
  for (int i = 0; i < rows; ++i) {
    const double t = at_s(i);
    text += fmt::format("{:.6f},{:.5f}\n", clock_s(i), 10.0 - 4.905 * t * t + noise(random));
  }
  return text;
}

TEST(TimeBursts, TimesOfArrivalAreNamedWithTheMeanStep) {
  const auto bursts = [](int i) { return (i / 6 * 6 + 5) / 120.0 + 0.0004 * (i % 6); };
  const auto told = read_campaign(kBody, fall(
                                             0.002, [](int i) { return i / 120.0; }, bursts));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, AllOf(HasSubstr("in bursts"), HasSubstr("row_every_s = 0.0083")));
  EXPECT_THAT(told.text, Not(HasSubstr("the clock stepped forward")));
  // A sensor that really samples six times in a row and then pauses.
  EXPECT_THAT(read_campaign(kBody, fall(0.0002, bursts, bursts)).text, Not(HasSubstr("in bursts")));
}

TEST(FallKink, FramesThatComeMoreSlowlyThanTheirTimesAreNamed) {
  const auto frames = [](int i) { return i < 20 ? i / 30.0 : 20.0 / 30.0 + (i - 20) / 24.0; };
  const auto mean = [&](int i) { return i * frames(35) / 35.0; };
  const auto told = read_campaign(kBody, fall(0.002, frames, mean, 36));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, AllOf(HasSubstr("nothing pulls a falling body"), HasSubstr("ffprobe")));
  EXPECT_THAT(read_campaign(kBody, fall(0.002, frames, frames, 36)).text, Not(HasSubstr("nothing pulls")));
}

TEST(FallKink, ABodyThatIsBrakedOrJumpsIsNot) {
  const auto hits_water = [](int i) { return i < 100 ? i / 120.0 : 100.0 / 120.0 + 0.4 * (i - 100) / 120.0; };
  EXPECT_THAT(read_campaign(kBody, fall(0.002, hits_water)).text, Not(HasSubstr("nothing pulls")));
  std::string swapped = "t_s,height_m\n";
  for (int i = 0; i < 100; ++i) {
    const double t = std::min(i, 75) / 120.0;
    swapped += fmt::format("{:.6f},{:.5f}\n", i / 120.0, 10.0 - 4.905 * t * t - (i > 75 ? 0.05 : 0.0));
  }
  EXPECT_THAT(read_campaign(kBody, swapped).text, Not(HasSubstr("nothing pulls")))
      << "a marker that stands still";
}

// A pendulum that is let go at `from_rad`; a stop at `stop_rad` gives back `rebound` of the speed.
std::string swing(
    double from_rad, double stop_rad, double rebound,
    const std::function<double(double)>& written = [](double q) { return q; }) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 2e-4);
  std::string text = "t_s,position_rad\n";
  double q = from_rad, w = 0.0;
  for (int i = 0; i < 400; ++i) {
    text += fmt::format("{:.2f},{:.6f}\n", 0.01 * i, written(q + noise(random)));
    for (int k = 0; k < 100; ++k) {
      w -= 1e-4 * (40.0 * std::sin(q) + std::tanh(50.0 * w));
      q += 1e-4 * w;
      if (q < stop_rad && w < 0.0) w *= -rebound;
    }
  }
  return text;
}

TEST(SharpTurns, AnAngleByAnArcsineIsNamed) {
  for (const double from_rad : {1.9, 2.2, 2.5}) {
    const auto told =
        read_campaign(kAxis, swing(from_rad, -9.0, 1.0, [](double q) { return std::asin(std::sin(q)); }));
    EXPECT_FALSE(told.recording.usable());
    EXPECT_THAT(told.text, AllOf(HasSubstr("arcsine"), HasSubstr("atan2")));
  }
}

TEST(SharpTurns, AnEndStopIsNotedWithTheRowsBeforeIt) {
  const auto told = read_campaign(kAxis, swing(1.0, -0.4, 0.7));
  EXPECT_TRUE(told.recording.usable());
  EXPECT_THAT(told.text, AllOf(HasSubstr("an end stop"), HasSubstr("select = { to_line = ")));
  const auto quarter = read_campaign(kAxis, swing(2.6, -0.5 * std::numbers::pi, 0.75));
  EXPECT_THAT(quarter.text, AllOf(HasSubstr("an end stop"), Not(HasSubstr("arcsine"))))
      << "a stop at 90 degrees";
}

TEST(SharpTurns, FreeSwingsHaveNone) {
  for (const double from_rad : {0.7, 1.3, 2.5})
    EXPECT_THAT(read_campaign(kAxis, swing(from_rad, -9.0, 1.0)).text,
                AllOf(Not(HasSubstr("end stop")), Not(HasSubstr("arcsine"))));
}

}  // namespace
}  // namespace sandhopper
