#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "tests/unit/read_campaign.hpp"

namespace sandhopper {
namespace {

using testing::HasSubstr;
using testing::Not;

Told coast_of(const std::string& text, double speed_mps) {
  return read_campaign(
      fmt::format("plant = \"falling_body\"\n[columns]\nt_s = {{ column = \"time (s)\", unit = \"s\" }}\n"
                  "height_m = {{ column = \"z (m)\", unit = \"m\" }}\n[every_trial]\nkind = \"drop\"\n"
                  "release_speed_mps = {}\nmass_kg = 18.0\ndiameter_m = 0.156\ndensity_kg_per_m3 = 1.17\n",
                  speed_mps),
      text);
}

// A rocket that coasts up at 80 m/s; rows come every 60 ms, the height is that of row `of(row)`.
Told coast(const std::function<int(int)>& of, double speed_mps = 80.0, double step_m = 1e-3) {
  std::string text = "time (s),z (m)\n";
  for (int i = 0; i < 40; ++i) {
    const double t_s = 0.06 * of(i);
    const double height_m = 150.0 + speed_mps * t_s - 0.5 * 12.0 * t_s * t_s;
    text += fmt::format("{:.2f},{:.3f}\n", 0.06 * i, step_m * std::round(height_m / step_m));
  }
  return coast_of(text, speed_mps);
}

// Rows 3, 5, 8, 10, … have a new sample; the rows before repeat one from before the first row.
int last_new(int row) {
  if (row < 3) return -2;
  return row % 5 < 3 ? row - row % 5 : row - row % 5 + 3;
}

std::size_t samples_of(const Told& told) {
  std::size_t count = 0;
  for (const double height : told.recording.channel("height_m")) count += !std::isnan(height);
  return count;
}

TEST(HeldHeights, RepeatsOfAMovingBodyAreNoSamples) {
  const auto held = coast(last_new);
  EXPECT_TRUE(held.recording.usable()) << held.text;
  EXPECT_THAT(held.text, HasSubstr("held samples, a new one comes every"));
  EXPECT_THAT(held.text, Not(HasSubstr("correct its unit or scale")));
  EXPECT_EQ(samples_of(held), 15U) << "of rows 3, 5, 8, 10, … 38";
}

TEST(HeldHeights, ASampleOfEachRowStays) {
  const auto all = coast([](int row) { return row; });
  EXPECT_EQ(all.text, "");
  EXPECT_EQ(samples_of(all), 40U);
}

TEST(HeldHeights, ACoarseHeightRepeatsWithoutBeingHeld) {
  const auto coarse = coast([](int row) { return row; }, 0.9, 0.1);
  EXPECT_THAT(coarse.text, Not(HasSubstr("held samples")));
}

TEST(HeldHeights, ARestBeforeTheMotionStays) {
  const auto rests = coast([](int row) { return row < 10 ? -2 : last_new(row - 10); });
  EXPECT_THAT(rests.text, HasSubstr("held samples"));
  EXPECT_FALSE(std::isnan(rests.recording.channel("height_m")[5]));
}

// Every second row repeats the one before; `holds` of them, and steps of `sizes` different lengths.
Told held_often(int holds, int sizes, double size_m) {
  std::string text = "time (s),z (m)\n";
  double height_m = 500.0;
  for (int i = 0; i < 40; ++i) {
    const bool repeats = i % 2 == 1 && i / 2 < holds;
    if (!repeats) height_m -= 1.0 + size_m * (i / 2 % sizes);
    text += fmt::format("{:.2f},{:.3f}\n", 0.06 * i, height_m);
  }
  return coast_of(text, 80.0);
}

TEST(HeldHeights, EightHoldsAreEnoughAndSevenAreNot) {
  EXPECT_THAT(held_often(9, 20, 0.023).text, HasSubstr("held samples"));
  EXPECT_THAT(held_often(8, 20, 0.023).text, Not(HasSubstr("held samples")));
}

// Of two rounded differences each is off by a digit at most.
TEST(HeldHeights, StepsAreOfManySizesIfTheyDifferByMoreThanTwoDigits) {
  EXPECT_THAT(held_often(20, 20, 0.003).text, HasSubstr("held samples"));
  EXPECT_THAT(held_often(20, 20, 0.002).text, Not(HasSubstr("held samples")));
}

// A window of 16 rows has too few held rows for check_held_heights; the cure is that of the message.
TEST(HeldHeights, AFewHeldRowsAreToldAsTheCauseAndTheCureIsRead) {
  const auto window = [](bool is_cured) {
    std::string text = "time (s),z (m)\n";
    for (int i = 0; i < 16; ++i) {
      const int of = i < 2 ? -2 : i == 5 || i == 8 ? i - 1 : i;
      const double t_s = 0.06 * of, height_m = 150.0 + 80.0 * t_s - 5.0 * t_s * t_s;
      const bool is_new = of == i;
      text +=
          fmt::format("{:.2f},{}\n", 0.06 * i, is_cured && !is_new ? "" : fmt::format("{:.3f}", height_m));
    }
    return coast_of(text, 80.0);
  };
  const auto held = window(false);
  EXPECT_FALSE(held.recording.usable());
  EXPECT_THAT(held.text,
              HasSubstr("such steps follow on a row that repeats the height before: held samples"));
  EXPECT_THAT(held.text, Not(HasSubstr("unit or scale")));
  EXPECT_TRUE(window(true).recording.usable()) << window(true).text;
}

TEST(HeldHeights, AnotherUnitIsStillDoubted) {
  const auto feet = coast([](int row) { return 4 * row; });
  EXPECT_FALSE(feet.recording.usable());
  EXPECT_THAT(feet.text, HasSubstr("faster than"));
}

}  // namespace
}  // namespace sandhopper
