#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "campaign_folder.hpp"
#include "tools/campaign/interpolated_samples.hpp"
#include "tools/campaign/lost_frames.hpp"

// Limits of the checks that use the samples alone: each with a case just inside and one just outside.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TrialRecording positions(std::vector<double> values, double row_s = 0.005) {
  TrialRecording recording;
  for (std::size_t i = 0; i < values.size(); ++i) recording.t_s.push_back(row_s * static_cast<double>(i));
  recording.channels.push_back({"position_rad", std::move(values)});
  return recording;
}

// A position by its steps from row to row, in digits of 0.001.
std::vector<double> by_steps(const std::vector<int>& steps) {
  std::vector<double> values{0.0};
  int at = 0;
  for (const int step : steps) values.push_back(0.001 * (at += step));
  return values;
}

bool is_interpolated(const std::vector<int>& steps) {
  auto recording = positions(by_steps(steps));
  check_interpolated(recording, {});
  return !recording.findings.empty();
}

// Straight lines of these lengths, each with the next slope of a motion without a rule.
std::vector<int> lines_of(std::size_t count, std::size_t rows) {
  constexpr int kSlopes[] = {90, -40, 130, 10, -100, 60, -10};
  std::vector<int> steps;
  for (std::size_t k = 0; k < count; ++k) steps.insert(steps.end(), rows, kSlopes[k % std::size(kSlopes)]);
  return steps;
}

// 2^-20 is less than one in a million, 2^-19 is not.
TEST(InterpolatedLimits, AGridOfTwoRowsNeedsTwentyGaps) {
  for (const std::size_t gaps : {19U, 20U}) {
    auto steps = lines_of(gaps + 1, 2);
    steps.insert(steps.end(), 20, 33);  // one more knot
    EXPECT_EQ(is_interpolated(steps), gaps == 20);
  }
}

TEST(InterpolatedLimits, RoundingIsNoKnotAndABendOfThreeDigitsIsOne) {
  for (const int stray : {1, 2}) {  // wrong digits of one row between two knots: it bends by twice that
    auto steps = lines_of(12, 10);
    steps[44] += stray == 1 ? 1 : 3;
    steps[45] -= stray == 1 ? 1 : 3;
    EXPECT_EQ(is_interpolated(steps), stray == 1);
  }
  auto off_grid = lines_of(12, 10);
  for (std::size_t i = 44; i < 50; ++i) off_grid[i] += 3;
  EXPECT_FALSE(is_interpolated(off_grid));
}

// To and fro with one slope that is larger by some digits.
std::vector<int> triangle(int larger, bool turns_between_rows) {
  std::vector<int> steps;
  for (int k = 0; k < 14; ++k) {
    const int slope = (k % 2 == 0 ? 100 : -100) + (k == 6 ? larger : 0);
    steps.insert(steps.end(), 9, slope);
    steps.push_back(turns_between_rows ? (k % 2 == 0 ? 20 : -20) : slope);
  }
  steps.pop_back();
  return steps;
}

TEST(InterpolatedLimits, AtOneSpeedAllBendsAreAlikeWithinTheirDigits) {
  EXPECT_FALSE(is_interpolated(triangle(3, false)));
  EXPECT_TRUE(is_interpolated(triangle(5, false)));
  EXPECT_FALSE(is_interpolated(triangle(7, true)));
  EXPECT_TRUE(is_interpolated(triangle(9, true)));
}

// The slopes of ramps and rests lie two bends apart. A motion that speeds up and slows down by equal bends
// goes through more slopes.
TEST(InterpolatedLimits, SlopesOfOneSpeedLieTwoBendsApart) {
  for (const int most : {2, 3}) {
    std::vector<int> steps;
    for (int k = 0; k < 6; ++k) {
      for (int slope = 0; slope < most; ++slope) steps.insert(steps.end(), 10, 50 * slope);
      for (int slope = most; slope > 0; --slope) steps.insert(steps.end(), 10, 50 * slope);
    }
    EXPECT_EQ(is_interpolated(steps), most == 3) << most;
  }
}

// Knots between two rows: nine lines with three rows or more between their knots.
TEST(InterpolatedLimits, LinesBetweenKnotsOffTheRowsAreNineAndThreeRowsLong) {
  const auto off_rows = [](std::size_t lines, std::size_t rows) {
    std::vector<int> steps(30, 5);  // a rest, which is longer than any line
    const auto slopes = lines_of(lines, 1);
    for (std::size_t k = 0; k < lines; ++k) {
      steps.push_back((steps.back() + slopes[k]) / 2);
      steps.insert(steps.end(), rows, slopes[k]);
    }
    steps.push_back((steps.back() + 5) / 2);
    steps.insert(steps.end(), 30, 5);
    return steps;
  };
  EXPECT_TRUE(is_interpolated(off_rows(9, 4)));
  EXPECT_FALSE(is_interpolated(off_rows(8, 4)));
  EXPECT_FALSE(is_interpolated(off_rows(12, 3)));
}

// Steps of one unit with some larger ones; the digit of the steps is 0.001.
bool has_lost_frames(double step, const std::vector<double>& jumps, double jitter = 0.0) {
  std::vector<double> values{0.0};
  for (std::size_t i = 0; i < 60; ++i) {
    const bool jumps_here = i % 15 == 10 && i / 15 < jumps.size();
    values.push_back(values.back() + (jumps_here ? jumps[i / 15] : step) + (i == 59 ? 0.001 : 0.0));
  }
  auto recording = positions(std::move(values), 0.01);
  for (std::size_t i = 1; i < recording.t_s.size(); i += 2) recording.t_s[i] += 0.5 * jitter * 0.01;
  check_lost_frames(recording, {});
  return !recording.findings.empty();
}

TEST(LostFramesLimits, ATimeFromTheRowNumberGrowsEvenly) {
  EXPECT_TRUE(has_lost_frames(1.0, {2.0, 2.0, 3.0}, 0.018));
  EXPECT_FALSE(has_lost_frames(1.0, {2.0, 2.0, 3.0}, 0.022));
}

TEST(LostFramesLimits, TwoJumpsMayBeSlips) {
  EXPECT_TRUE(has_lost_frames(1.0, {2.0, 2.0, 3.0}));
  EXPECT_FALSE(has_lost_frames(1.0, {2.0, 3.0}));
}

// Three numbers that are within 0.1 of a whole one are so by chance with 0.8 %, within 0.115 with 1.2 %.
TEST(LostFramesLimits, JumpsAreWholeStepsBeyondChance) {
  EXPECT_TRUE(has_lost_frames(1.0, {2.1, 2.1, 2.1}));
  EXPECT_FALSE(has_lost_frames(1.0, {2.115, 2.115, 2.115}));
}

// A recorder that reads samples in its own time skips some and reads others twice. As many or more are
// skipped by chance: 9 of 12 with 7.3 %, 11 of 12 with 0.3 %.
TEST(LostFramesLimits, SamplesThatAreReadTwiceAsOftenAsTheyAreSkippedAreOnlyLate) {
  const auto is_seen = [](int skipped) {
    std::vector<double> values{0.0};
    for (int i = 0; i < 200; ++i) {
      const bool special = i % 15 == 10 && i / 15 < 12;
      const double times = !special ? 1.0 : i / 15 < skipped ? 2.0 : 0.0;
      values.push_back(values.back() + times + (i == 199 ? 0.001 : 0.0));
    }
    auto recording = positions(std::move(values), 0.01);
    check_lost_frames(recording, {});
    return !recording.findings.empty();
  };
  EXPECT_FALSE(is_seen(6));
  EXPECT_FALSE(is_seen(9));
  EXPECT_TRUE(is_seen(11));
}

// An encoder whose smallest step is 1; its other steps and their sums are whole numbers, too.
TEST(LostFramesLimits, AJumpIsClearOfTheEncodersStep) {
  const auto is_seen = [](int step) {
    std::vector<double> values{0.0};
    for (int i = 0; i < 80; ++i) {
      const int more = i == 75 ? 1 : 0;  // the encoder's step
      values.push_back(values.back() + (i % 15 == 10 && i < 60 ? 2 * step : step + more));
    }
    auto recording = positions(std::move(values), 0.01);
    check_lost_frames(recording, {});
    return !recording.findings.empty();
  };
  EXPECT_FALSE(is_seen(4));
  EXPECT_TRUE(is_seen(6));
}

// All findings of a press with a foot of this radius.
std::string told_of_press(double radius_m, const std::string& columns, const std::string& csv) {
  CampaignFolder folder;
  folder.write("nominal.toml", fmt::format("[foot]\nradius_m = {:.9f}\n", radius_m))
      .write("campaign.toml", "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[columns]\n" + columns +
                                  "\n[[trial]]\nfile = \"a.csv\"\n")
      .write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  std::string told;
  for (const auto& finding : read_trial(campaign, campaign.trials.at(0)).findings)
    told += to_string(finding) + "\n";
  return told;
}

// Depths from `from_m` down to 36 mm, 0.14 mm from row to row.
std::vector<double> down_from(double from_m) {
  std::vector<double> depths_m;
  for (double depth_m = from_m; depth_m < 0.036; depth_m += 1.4e-4) depths_m.push_back(depth_m);
  return depths_m;
}

// A press with noise of 0.1 N in the force; in the depth, one of +-`jitter_m` from row to row.
template <class Force>
std::string press(Force force_N, double radius_m = 0.03,
                  const std::vector<double>& depths_m = down_from(-0.02), double jitter_m = 0.0) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (std::size_t k = 0; k < depths_m.size(); ++k) {
    const int i = static_cast<int>(k);
    const double a = std::fmod(std::abs(std::sin(12.9898 * (i + 1)) * 43758.5453), 1.0);
    const double b = std::fmod(std::abs(std::sin(78.233 * (i + 1)) * 12543.1234), 1.0);
    const double white = std::sqrt(-2.0 * std::log(a + 1e-12)) * std::cos(2.0 * std::numbers::pi * b);
    text +=
        fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.005 * i, -depths_m[k] - (i % 2 == 0 ? jitter_m : -jitter_m),
                    force_N(depths_m[k]) + 0.1 * white);
  }
  return told_of_press(radius_m, "", text);
}

// A bed of 1500 N/m that begins at this depth.
auto bed_from(double surface_m) {
  return [surface_m](double depth_m) { return 1500.0 * std::max(0.0, depth_m - surface_m); };
}

const char* const kAboveZero = "above depth 0, where nothing";
const char* const kBelowZero = "grows faster than with the cube of the depth";

// Above the bed the force grows from the first third of its way to the last by 1.6 or 3.2.
TEST(SurfaceOnsetLimits, AForceAboveTheBedThatDoublesIsABed) {
  const auto told = [](double end_N) {
    return press([&](double depth_m) {
      const double above = depth_m < -0.006 ? 0.0 : 10.0 + (end_N - 10.0) * (depth_m + 0.006) / 0.006;
      return depth_m < 0.0 ? above : end_N + 1000.0 * depth_m;
    });
  };
  EXPECT_THAT(told(21.0), Not(HasSubstr(kAboveZero)));
  EXPECT_THAT(told(90.0), HasSubstr(kAboveZero));
}

// One edge of a foot of 0.1 m that is two degrees out of level touches 7 mm before the other.
TEST(SurfaceOnsetLimits, AFootOutOfLevelTouchesEarly) {
  EXPECT_THAT(press(bed_from(-0.005), 0.1), Not(HasSubstr(kAboveZero)));
  EXPECT_THAT(press(bed_from(-0.010), 0.1), HasSubstr(kAboveZero));
}

// A jitter of 0.4 mm counts as 1 mm of noise.
TEST(SurfaceOnsetLimits, ADifferenceOfFiveStandardDeviationsOfTheDepthIsNone) {
  EXPECT_THAT(press(bed_from(-0.0040), 0.02, down_from(-0.02), 4e-4), Not(HasSubstr(kAboveZero)));
  EXPECT_THAT(press(bed_from(-0.0070), 0.02, down_from(-0.02), 4e-4), HasSubstr(kAboveZero));
}

// From half of the depth on it is a hole, which another check tells.
TEST(SurfaceOnsetLimits, ASurfaceFarBelowZeroIsAHole) {
  EXPECT_THAT(press(bed_from(0.016)), HasSubstr(kBelowZero));
  EXPECT_THAT(press(bed_from(0.021)), Not(HasSubstr(kBelowZero)));
}

// The foot comes back by some of the 56 mm of its way before it meets the bed.
TEST(SurfaceOnsetLimits, AStrokeEndsWhereTheFootComesBackByATenth) {
  const auto told = [](double back_m) {
    auto depths_m = down_from(-0.02);
    std::vector<double> up;
    for (double depth_m = -0.01; depth_m > -0.01 - back_m; depth_m -= 1.4e-4) up.push_back(depth_m);
    for (double depth_m = -0.01 - back_m; depth_m < -0.01; depth_m += 1.4e-4) up.push_back(depth_m);
    const auto turn = std::ranges::lower_bound(depths_m, -0.01);
    depths_m.insert(turn, up.begin(), up.end());
    return press(bed_from(-0.006), 0.03, depths_m);
  };
  EXPECT_THAT(told(0.0045), HasSubstr(kAboveZero));
  EXPECT_THAT(told(0.0073), Not(HasSubstr(kAboveZero)));
}

// A press whose depth states no unit; `most_N` at 36 mm.
std::string press_without_unit(double radius_m, double most_N) {
  std::string text = "t_s,depth,force_N\n";
  for (int i = 0; i < 200; ++i) {
    const double depth_m = -0.02 + 0.056 * i / 199.0;
    text +=
        fmt::format("{:.2f},{:.6f},{:.4f}\n", 0.01 * i, -depth_m, std::max(0.0, most_N * depth_m / 0.036));
  }
  return told_of_press(radius_m, "foot_z_m = \"depth\"", text);
}

TEST(DepthUnitLimits, AProbeGoesDownAHundredDiametersAtMost) {
  EXPECT_THAT(press_without_unit(0.018 / 90.0, 54.0), Not(HasSubstr("diameters of a foot")));
  EXPECT_THAT(press_without_unit(0.018 / 110.0, 54.0), HasSubstr("diameters of a foot"));
}

// Grains of 100 kg/m3 bear 7.1 N at 36 mm below a foot of 0.1 m.
TEST(DepthUnitLimits, EvenTheLightestGrainsBearSomething) {
  EXPECT_THAT(press_without_unit(0.1, 8.0), Not(HasSubstr("kg/m3 bear")));
  EXPECT_THAT(press_without_unit(0.1, 6.0), HasSubstr("kg/m3 bear"));
}

}  // namespace
}  // namespace sandhopper
