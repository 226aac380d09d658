#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "read_campaign.hpp"

// Both sides of the limits that decide which samples are in doubt.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;

bool says(const Told& told, const std::string& text) { return told.text.find(text) != std::string::npos; }

// A swinging axis. Its position jumps by `step_rad` after half of the rows, of which the first `missing` are
// not there.
struct Swing {
  double step_rad = -2.0;
  int missing = 0, rows = 400;
};
bool zero_is_set_anew(const Swing& swing) {
  std::string text = "t_s,position_rad\n";
  for (int i = 0; i < swing.rows + swing.missing; ++i) {
    const bool after = i >= swing.rows / 2;
    if (after && i < swing.rows / 2 + swing.missing) continue;
    text +=
        fmt::format("{:.3f},{:.5f}\n", 0.005 * i, 0.5 * std::cos(0.022 * i) + (after ? swing.step_rad : 0.0));
  }
  return says(read_campaign("plant = \"rotary_axis\"", text), "its zero was set anew");
}

// The swing itself takes at most 0.011 rad from row to row.
TEST(SampleLimits, AJumpIsTenTimesTheNextLargestStep) {
  EXPECT_FALSE(zero_is_set_anew({.step_rad = 0.09}));
  EXPECT_TRUE(zero_is_set_anew({.step_rad = 0.12}));
}

TEST(SampleLimits, AJumpAcrossTwoMissingRowsIsMotionInAGap) {
  EXPECT_TRUE(zero_is_set_anew({.missing = 1}));
  EXPECT_FALSE(zero_is_set_anew({.missing = 2}));
}

TEST(SampleLimits, AJumpNeedsAHundredSamples) {
  EXPECT_TRUE(zero_is_set_anew({.rows = 100}));
  EXPECT_FALSE(zero_is_set_anew({.rows = 99}));
}

bool has_too_few_digits(int values, int rows) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < rows; ++i)
    text += fmt::format("{:.2f},{:.5f},{}\n", 0.01 * i, -1e-4 * i, 10 * (7 * i % values));
  return says(read_campaign("plant = \"intruder\"", text), "different values");
}

TEST(SampleLimits, AChannelWithThreeToTenValuesHasTooFewDigits) {
  EXPECT_FALSE(has_too_few_digits(2, 200));
  EXPECT_TRUE(has_too_few_digits(3, 200));
  EXPECT_TRUE(has_too_few_digits(10, 200));
  EXPECT_FALSE(has_too_few_digits(11, 200));
  EXPECT_TRUE(has_too_few_digits(10, 100));
  EXPECT_FALSE(has_too_few_digits(10, 99));
}

// Rows of a press; the last ones repeat. The depth moves in `moving` of ten rows.
std::size_t rows_kept(int before, int filled, int moving = 10) {
  std::string text = "t_s,foot_z_m,force_N\n";
  int depth = 0;
  for (int i = 0; i < before + filled; ++i) {
    depth += i < before && i % 10 < moving ? 1 : 0;
    const int at = std::min(i, before - 1);
    text += fmt::format("{:.2f},{:.5f},{:.4f}\n", 0.01 * i, -2e-4 * depth,
                        0.3 * at + 0.02 * std::sin(7.0 * at * at));
  }
  return read_campaign("plant = \"intruder\"", text).recording.rows();
}

TEST(SampleLimits, TenRepeatedRowsAtTheEndAreLeftOut) {
  EXPECT_EQ(rows_kept(100, 9), 109U);
  EXPECT_EQ(rows_kept(100, 10), 100U);
  EXPECT_EQ(rows_kept(10, 40), 10U);
  EXPECT_EQ(rows_kept(9, 40), 49U) << "too little before them to tell";
}

TEST(SampleLimits, RepeatedRowsMeanNothingIfAChannelRestsOften) {
  EXPECT_EQ(rows_kept(100, 40, 9), 100U);
  EXPECT_EQ(rows_kept(100, 40, 7), 140U);
}

// The clock of the first rows of an axis is `later_s` behind.
std::string with_late_clock(double later_s, int first) {
  std::string text = "t_s,position_rad\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{:.3f},{:.5f}\n", 0.01 * i + (i < first ? 0.0 : later_s), 0.5 * std::cos(0.05 * i));
  return text;
}

TEST(SampleLimits, AClockThatJumpsByThreeYearsWasNotSet) {
  const auto unset = [](double later_s, int first) {
    return says(read_campaign("plant = \"rotary_axis\"", with_late_clock(later_s, first)), "was not set yet");
  };
  EXPECT_FALSE(unset(0.9e8, 3));
  EXPECT_TRUE(unset(1.1e8, 3));
  EXPECT_TRUE(unset(1.1e8, 49));
  EXPECT_FALSE(unset(1.1e8, 51)) << "no half of a recording is a clock that was not set";
}

// A force that stands at its largest value for `still` rows at the end, while the foot goes on by `share` of
// its way.
bool is_cut_off(double share, int still) {
  const int moving = 200 - still;
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 200; ++i) {
    const double way =
        i < moving ? (1.0 - share) * i / (moving - 1) : 1.0 - share + share * (i - moving) / (still - 1);
    text += fmt::format("{:.2f},{:.6f},{:.4f}\n", 0.01 * i, -0.04 * way,
                        i < moving ? 0.15 * i + 0.02 * std::sin(7.0 * i * i) : 40.0);
  }
  return says(read_campaign("plant = \"intruder\"", text), "force_N: is saturated");
}

TEST(SampleLimits, AForceAtItsLargestValueIsCutOffIfTheFootGoesOnByATenth) {
  EXPECT_FALSE(is_cut_off(0.09, 30));
  EXPECT_TRUE(is_cut_off(0.11, 30));
  EXPECT_FALSE(is_cut_off(0.11, 4));
  EXPECT_TRUE(is_cut_off(0.11, 5));
}

// A plate that sinks evenly. Before row 60 the clock jumps by `jump_s`, the plate goes on by `on` rows, and
// the force by `step_N` more; then the plate is `faster` times as fast.
struct Forward {
  double jump_s = 2.0, on = 1.0, step_N = 0.0, faster = 1.0;
  std::string columns{};
};
bool is_set_forward(const Forward& f) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 120; ++i) {
    const bool after = i >= 60;
    const double at = after ? 59.0 + f.on + f.faster * (i - 60) : i;
    text += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.01 * i + (after ? f.jump_s - 0.01 : 0.0), -2e-4 * at,
                        0.3 * at + (after ? f.step_N : 0.0) + 0.02 * std::sin(7.0 * i * i));
  }
  const auto told = read_campaign("plant = \"intruder\"\n" + f.columns, text);
  return says(told, "the clock stepped forward") && !told.recording.usable();
}

TEST(SampleLimits, AClockIsSetForwardIfThePositionGoesOnByOneRow) {
  EXPECT_TRUE(is_set_forward({}));
  EXPECT_FALSE(is_set_forward({.on = 200.0})) << "rows are missing";
  EXPECT_TRUE(is_set_forward({.on = 1.4}));
  EXPECT_FALSE(is_set_forward({.on = 1.6}));
  EXPECT_TRUE(is_set_forward({.jump_s = 0.105}));
  EXPECT_FALSE(is_set_forward({.jump_s = 0.095})) << "shorter than ten rows";
  EXPECT_TRUE(is_set_forward({.faster = 1.3}));
  EXPECT_FALSE(is_set_forward({.faster = 1.4})) << "the speed is another one";
  EXPECT_TRUE(is_set_forward({.step_N = 0.5}));
  EXPECT_FALSE(is_set_forward({.step_N = 1.0})) << "the force went on meanwhile";
  EXPECT_FALSE(
      is_set_forward({.columns = "[columns]\nt_s = { column = \"t_s\", unit = \"s\", scale = 1.0 }"}));
}

// Two columns of times; the second is `rate` times as fast and rests in each `rests`-th row.
// A wheel that gives a pulse every 0.075 rad and comes to rest: 60 times as slow at the end as at first.
TEST(SampleLimits, ASlowPulseIsNoStepOfTheClock) {
  std::string text = "t_s,position_rad\n";
  double t_s = 0.0;
  for (int i = 0; i < 400; ++i) {
    text += fmt::format("{:.5f},{:.4f}\n", t_s, 0.075 * i);
    t_s += i < 300 ? 0.0036 : 0.0036 * std::exp(0.041 * (i - 300));
  }
  EXPECT_FALSE(says(read_campaign("plant = \"rotary_axis\"", text), "the clock stepped forward"));
}

Told two_clocks(double rate, int rests = 1000, const std::string& columns = "") {
  std::string text = "t_s,force_N,laser_time_s,foot_z_m\n";
  double second_s = 0.0;
  for (int i = 0; i < 200; ++i) {
    if (i % rests != 0) second_s = 0.01 * rate * i;
    text += fmt::format("{:.3f},{:.4f},{:.5f},{:.6f}\n", 0.01 * i, 0.3 * i + 0.02 * std::sin(7.0 * i * i),
                        second_s, -2e-4 * i);
  }
  return read_campaign("plant = \"intruder\"\n" + columns, text);
}

TEST(SampleLimits, ASecondColumnOfTimesMayDriftByOnePercent) {
  EXPECT_FALSE(two_clocks(1.02).recording.usable());
  EXPECT_THAT(two_clocks(1.02).text, HasSubstr("laser_time_s: holds other times than the column of t_s"));
  EXPECT_TRUE(two_clocks(1.009).recording.usable());
  EXPECT_FALSE(two_clocks(1.02, 11).recording.usable());
  EXPECT_TRUE(two_clocks(1.02, 9).recording.usable()) << "too coarse to be a time of rows";
  EXPECT_TRUE(two_clocks(1.02, 1000, "[columns]\nt_s = { column = \"t_s\", unit = \"s\", scale = 1.0 }")
                  .recording.usable());
}

// A plate that sinks evenly, with a second column that counts 1, 1.5, 1, 1.5 … times `count` a row.
Told with_counter(const std::string& time, const std::string& other, double count) {
  std::string text = fmt::format("{},{},Force (N),Depth (mm)\n", time, other);
  double sum = 500.0;
  for (int i = 0; i < 200; ++i, sum += i % 40 < 20 ? count : 1.5 * count)
    text += fmt::format("{:.3f},{:.4f},{:.4f},{:.3f}\n", 0.01 * i, sum, 0.3 * i, 0.2 * i);
  return read_campaign(
      fmt::format("plant = \"intruder\"\n[columns]\nt_s = {{ column = \"{}\", unit = \"s\" }}\n"
                  "force_N = \"Force (N)\"\nfoot_z_m = {{ column = \"Depth (mm)\", unit = "
                  "\"mm\", scale = -0.001 }}\n",
                  time),
      text);
}

TEST(SampleLimits, ACounterThatIsCalledATimeIsNoOtherClock) {
  const auto counter = with_counter("time aprox (s)", "time(not s)", 2.0);
  EXPECT_TRUE(counter.recording.usable()) << counter.text;
  EXPECT_THAT(counter.text, HasSubstr("time(not s): is called a time, states no unit"));
  EXPECT_FALSE(with_counter("time (s)", "time2 [ms]", 9.0).recording.usable()) << "the note's advice";
  EXPECT_FALSE(with_counter("time1", "time2", 0.01).recording.usable()) << "both in the same unit";
  EXPECT_TRUE(with_counter("time1", "time2", 2.0).recording.usable());
}

// The way out that the message names.
TEST(SampleLimits, EachSensorIsReadWithItsOwnTimes) {
  CampaignFolder folder;
  std::string text = "force_t (s),Force (N),depth_t (s),Depth (mm)\n";
  for (int i = 0; i < 100; ++i)
    text += fmt::format("{:.3f},{:.4f},{:.3f},{:.4f}\n", 0.01 * i, 0.3 * i + 0.02 * std::sin(7.0 * i * i),
                        0.015 * i, 0.3 * i);
  folder.write("a.csv", text)
      .write("campaign.toml",
             "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\n"
             "columns = { t_s = { column = \"force_t (s)\", unit = \"s\", scale = 1.0 }, force_N = \"Force "
             "(N)\" }\n"
             "also = { file = \"a.csv\", columns = { t_s = { column = \"depth_t (s)\", unit = \"s\", scale = "
             "1.0 }, "
             "foot_z_m = { column = \"Depth (mm)\", unit = \"mm\", scale = -0.001 } } }\n");
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  ASSERT_TRUE(recording.usable());
  const auto depth = recording.channel("foot_z_m");
  std::size_t samples = 0;
  for (std::size_t row = 0; row < depth.size(); ++row) {
    if (std::isnan(depth[row])) continue;
    EXPECT_NEAR(depth[row], -0.02 * recording.t_s[row], 1e-6);
    ++samples;
  }
  EXPECT_GT(samples, 60U);
}

// A speed of 10 sin(6 t) rad/s whose counter holds `width`. Only its first `rows` rows are so large.
bool has_full_speed(double width, int rows = 200) {
  std::string text = "t_s,velocity_radps,position_rad\n";
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i, v = 10.0 * std::sin(6.0 * t) * (i < rows ? 1.0 : 0.8);
    text += fmt::format("{:.2f},{:.5f},{:.6f}\n", t, v - width * std::round(v / width),
                        -10.0 / 6.0 * std::cos(6.0 * t));
  }
  return says(read_campaign("plant = \"rotary_axis\"", text), "as a counter does that is full");
}

TEST(SampleLimits, ASpeedWhoseCounterIsFullIsInDoubt) {
  EXPECT_TRUE(has_full_speed(18.0));
  EXPECT_FALSE(has_full_speed(21.0));
  EXPECT_TRUE(has_full_speed(18.0, 100)) << "four jumps";
  EXPECT_FALSE(has_full_speed(18.0, 50)) << "two";
}

}  // namespace
}  // namespace sandhopper
