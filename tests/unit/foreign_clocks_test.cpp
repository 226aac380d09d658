#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "firmware/log/csv_time_code.hpp"
#include "read_campaign.hpp"

// Time codes of cameras, and times that begin again when a part of them is full. The cure of each message is
// followed, and sound neighbours are read as before.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

double force_N(int i) { return 10.0 + 0.01 * i * i + 0.01 * std::sin(7.0 * i); }

Told read_rows(const std::string& time_column, const std::function<std::string(int)>& time, int rows,
               const std::string& campaign) {
  std::string text = time_column + ",force_N,foot_z_m\n";
  for (int i = 0; i < rows; ++i) text += fmt::format("{},{:.4f},{:.5f}\n", time(i), force_N(i), -4e-4 * i);
  return read_campaign("plant = \"intruder\"\n[columns]\nt_s = { column = \"" + time_column +
                           "\", unit = \"s\" }\n" + campaign,
                       text);
}
std::string code(int frame, int per_s) {
  return fmt::format("10:00:{:02}:{:02}", frame / per_s, frame % per_s);
}

TEST(ForeignClocks, ATimeCodeIsReadWithItsFramesPerSecond) {
  const auto time = [](int i) { return code(i, 25); };
  const auto asked = read_rows("Timecode", time, 100, "");
  EXPECT_FALSE(asked.recording.usable());
  EXPECT_THAT(asked.text, AllOf(HasSubstr("frames, ms, or a part of a second?"),
                                HasSubstr("[format] frames_per_s = 25")));
  const auto read = read_rows("Timecode", time, 100, "[format]\nframes_per_s = 25\n");
  ASSERT_TRUE(read.recording.usable()) << read.text;
  EXPECT_NEAR(read.recording.t_s[99] - read.recording.t_s[0], 99.0 / 25.0, 1e-9);
}

TEST(ForeignClocks, FramesPerSecondThatTheCodeContradictsAreRefused) {
  const auto time = [](int i) { return code(i, 25); };
  const auto many = read_rows("Timecode", time, 120, "[format]\nframes_per_s = 30\n");
  EXPECT_FALSE(many.recording.usable());
  EXPECT_THAT(many.text, HasSubstr("numbered up to 24, and [format] states frames_per_s = 30"));
  const auto few = read_rows("Timecode", time, 120, "[format]\nframes_per_s = 24\n");
  EXPECT_THAT(few.text, HasSubstr("numbered up to 24, and [format] states frames_per_s = 24"));
  // Every second frame of 30: 28 is the largest number, and 30 are right.
  const auto halved = read_rows(
      "Timecode", [](int i) { return code(2 * i, 30); }, 120, "[format]\nframes_per_s = 30\n");
  EXPECT_TRUE(halved.recording.usable()) << halved.text;
}

TEST(ForeignClocks, PartsOfASecondThatAreNotPaddedAreReadAsACount) {
  const auto read = read_rows(
      "Time", [](int i) { return fmt::format("10:00:{:02}:{}", i * 50 / 1000, i * 50 % 1000); }, 100,
      "[format]\nframes_per_s = 1000\n");
  ASSERT_TRUE(read.recording.usable()) << read.text;
  EXPECT_NEAR(read.recording.t_s[99] - read.recording.t_s[0], 4.95, 1e-9);
}

TEST(ForeignClocks, ATimeCodeCountsFramesAndNotSeconds) {
  const double ntsc = 30000.0 / 1001.0;
  // An hour of the code without drops takes 3603.6 s; with drops it is right to two frames.
  EXPECT_NEAR(seconds_of(*time_code_in("01:00:00:00"), ntsc), 3603.6, 1e-9);
  EXPECT_NEAR(seconds_of(*time_code_in("01:00:00;00"), ntsc), 3600.0, 0.07);
  EXPECT_NEAR(seconds_of(*time_code_in("00:01:00;02"), ntsc) - seconds_of(*time_code_in("00:00:59;29"), ntsc),
              1.0 / ntsc, 1e-9);
  EXPECT_EQ(seconds_of(*time_code_in("00:00:01:12"), 24.0), 1.5);
  for (const auto* text :
       {"10:00:00", "10:00:00.12", "10:61:00:12", "10:00:00:", "a:00:00:12", "10:00:00:12x"})
    EXPECT_FALSE(time_code_in(text)) << text;
}

TEST(ForeignClocks, SecondsOfAMinuteAreNamedAndGoOnWithTheirFullValue) {
  const auto time = [](int i) { return fmt::format("{:.3f}", std::fmod(57.0 + 0.05 * i, 60.0)); };
  const auto asked = read_rows("Time (s)", time, 200, "");
  EXPECT_FALSE(asked.recording.usable());
  EXPECT_THAT(asked.text, HasSubstr("begins again whenever 60 is reached"));
  EXPECT_THAT(asked.text, HasSubstr("time_restarts_at = 60"));
  const auto read = read_rows("Time (s)", time, 200, "[format]\ntime_restarts_at = 60\n");
  ASSERT_TRUE(read.recording.usable()) << read.text;
  EXPECT_EQ(read.recording.rows(), 200U);
  EXPECT_NEAR(read.recording.t_s[199] - read.recording.t_s[0], 199 * 0.05, 1e-9);
}

TEST(ForeignClocks, MillisecondsOfASecondGoOnInTheUnitOfTheirColumn) {
  std::string text = "Time (ms),force_N,foot_z_m\n";
  for (int i = 0; i < 200; ++i)
    text += fmt::format("{},{:.4f},{:.5f}\n", (700 + 20 * i) % 1000, force_N(i), -4e-4 * i);
  const std::string head =
      "plant = \"intruder\"\n[columns]\nt_s = { column = \"Time (ms)\", unit = \"ms\" }\n";
  EXPECT_THAT(read_campaign(head, text).text, HasSubstr("time_restarts_at = 1000"));
  const auto read = read_campaign(head + "[format]\ntime_restarts_at = 1000\n", text);
  ASSERT_TRUE(read.recording.usable()) << read.text;
  EXPECT_NEAR(read.recording.t_s[199] - read.recording.t_s[0], 199 * 0.02, 1e-9);
}

TEST(ForeignClocks, RecordingsOneBelowTheOtherAreNoPartOfATime) {
  const auto told = read_rows(
      "Time (s)", [](int i) { return fmt::format("{:.2f}", 0.05 * (i % 70)); }, 200, "");
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("several recordings one below the other"));
  EXPECT_THAT(told.text, Not(HasSubstr("time_restarts_at")));
}

}  // namespace
}  // namespace sandhopper
