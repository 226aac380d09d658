#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "read_campaign.hpp"

// One channel jumps in one row while the foot or the axis goes on.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// A press of 400 rows from 5 mm above a bed of 2000 N/m. `read_N` turns the force of a row into that read.
std::string press(const std::function<double(int row, double force_N)>& read_N) {
  std::string csv = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 400; ++i) {
    const double depth_m = 1e-4 * i - 0.005, noise_N = 0.05 * std::sin(7.0 * i * i);
    csv += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.005 * i, -depth_m,
                       read_N(i, 2000.0 * std::max(0.0, depth_m) + noise_N));
  }
  return read_campaign("plant = \"intruder\"\n[every_trial]\nkind = \"intrusion\"", csv).text;
}

constexpr int kThere = 250;  // the row of the jump, at 40 N

TEST(ForceSteps, ATareUnderLoadIsInDoubt) {
  EXPECT_THAT(press([](int i, double force_N) { return force_N - (i < kThere ? 0.0 : 40.0); }),
              AllOf(HasSubstr("in line 252"), HasSubstr("the cell was tared under load")));
}

TEST(ForceSteps, AnotherUnitOrGainIsInDoubt) {
  for (const double times : {0.001, 10.0})
    EXPECT_THAT(press([&](int i, double force_N) { return force_N * (i < kThere ? 1.0 : times); }),
                HasSubstr(fmt::format("the force goes on at {:g} times its value and slope", times)));
  // The amplifier flickers before it stays.
  EXPECT_THAT(
      press([](int i, double force_N) { return force_N * (i < kThere || i == kThere + 1 ? 1.0 : 10.0); }),
      AllOf(HasSubstr("the force goes on at 10 times"), HasSubstr("to_line = 251"),
            HasSubstr("from_line = 254")));
}

TEST(ForceSteps, AChangeOfSignIsInDoubt) {
  EXPECT_THAT(press([](int i, double force_N) { return i < kThere ? force_N : force_N - 65.536; }),
              HasSubstr("the force changes its sign, and a bed only pushes"));
}

TEST(ForceSteps, GroundThatYieldsStaysSilent) {
  const auto is_silent = [](const std::function<double(int, double)>& read_N) {
    EXPECT_THAT(press(read_N), Not(HasSubstr("while the foot goes on")));
  };
  is_silent([](int, double force_N) { return force_N; });
  // A crust breaks: the force falls to a part, and goes on as in the bed below.
  is_silent([](int i, double force_N) { return force_N - (i < kThere ? 0.0 : 25.0); });
  // A crust above a hollow: nothing bears any more.
  is_silent([](int i, double force_N) { return i < kThere ? force_N : 0.1 + 0.02 * std::sin(1.0 * i); });
  // The foot meets a stone.
  is_silent([](int i, double force_N) { return i < kThere ? force_N : 10.0 * force_N - 150.0; });
}

TEST(ForceSteps, ASampleThatFailedStaysSilent) {
  EXPECT_THAT(press([](int i, double force_N) { return i == kThere ? -40.0 : force_N; }),
              Not(HasSubstr("while the foot goes on")));
}

// The wrapped counts of a converter: its steps are 4 % of half its width, but it fills the width.
TEST(ForceSteps, ACounterThatFillsItsWidthIsPutBack) {
  std::string csv = "t_s,foot_z_m,F\n";
  for (int i = 0; i < 400; ++i) {
    const double depth_m = 1e-4 * i - 0.005;
    auto count = std::lround(2e6 * std::max(0.0, depth_m) + 1000.0 * std::sin(7.0 * i * i));
    while (count > 32767) count -= 65536;
    csv += fmt::format("{:.3f},{:.6f},{}\n", 0.005 * i, -depth_m, count);
  }
  const auto told = read_campaign(
      "plant = \"intruder\"\n[columns]\nforce_N = { column = \"F\", unit = \"mN\" }\n"
      "[every_trial]\nkind = \"intrusion\"",
      csv);
  EXPECT_THAT(told.text, HasSubstr("2^16"));
  EXPECT_NEAR(told.recording.channel("force_N").back(), 69.8, 2.0);
}

// A pendulum of 400 rows. `shift_rad` is added to a row.
std::string swing(const std::function<double(int row)>& shift_rad) {
  std::string csv = "t_s,position_rad\n";
  for (int i = 0; i < 400; ++i)
    csv += fmt::format("{:.3f},{:.5f}\n", 0.005 * i,
                       0.5 * std::cos(0.1 * i) + 2e-5 * std::sin(7.0 * i * i) + shift_rad(i));
  return read_campaign("plant = \"rotary_axis\"", csv).text;
}

// Its steps reach 0.05 rad.
TEST(ForceSteps, AnEncoderThatSlipsIsInDoubt) {
  const auto told = swing([](int i) { return i < 200 ? 0.0 : 0.15; });
  EXPECT_THAT(told, AllOf(HasSubstr("goes 0.15 rad farther in line 202"), HasSubstr("the encoder slipped")));
}

TEST(ForceSteps, MotionOfAnAxisStaysSilent) {
  EXPECT_THAT(swing([](int) { return 0.0; }), IsEmpty());
  EXPECT_THAT(swing([](int i) { return i == 200 ? 0.15 : 0.0; }), Not(HasSubstr("slipped")));  // a glitch
  // A stop reverses the axis, and a motor drives it from hold to hold within one row.
  EXPECT_THAT(swing([](int i) { return 0.04 * std::abs(i - 200.5); }), Not(HasSubstr("slipped")));
  std::string csv = "t_s,position_rad\n";
  for (int i = 0; i < 400; ++i)
    csv += fmt::format("{:.3f},{:.5f}\n", 0.05 * i, (i < 200 ? 0.1 : 0.4) + 2e-4 * std::sin(7.0 * i * i));
  EXPECT_THAT(read_campaign("plant = \"rotary_axis\"", csv).text, Not(HasSubstr("slipped")));
}

}  // namespace
}  // namespace sandhopper
