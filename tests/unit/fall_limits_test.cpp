#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "tests/unit/read_campaign.hpp"

namespace sandhopper {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// A ball of 145 g and 73 mm that is let go at 5 m and falls through air; times are written `slower` times
// longer.
std::string ball(double slower = 1.0) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1e-3);
  constexpr double kDrag = 0.5 * 1.2 * 0.0041854 * 0.5 / 0.145;
  std::string text = "t_s,height_m\n";
  double height = 5.0, speed = 0.0;
  for (int i = 0; i < 200 && height > 0.0; ++i) {
    text += fmt::format("{:.3f},{:.5f}\n", slower * 0.005 * i, height + noise(random));
    const double accel = 9.81 - kDrag * speed * speed;
    height -= speed * 0.005 + 0.5 * accel * 2.5e-5;
    speed += accel * 0.005;
  }
  return text;
}

std::string head(const std::string& setup, const std::string& columns = "") {
  return "plant = \"falling_body\"\n" + columns + "[every_trial]\nkind = \"drop\"\n" + setup;
}

constexpr const char* kBall = "mass_kg = 0.145\ndiameter_m = 0.073\ndensity_kg_per_m3 = 1.2\n";

TEST(FallLimits, ASoundFallStays) {
  EXPECT_EQ(read_campaign(head(kBall), ball()).text, "");
  EXPECT_EQ(read_campaign(head(std::string(kBall) + "release_height_m = 5.0\n"), ball()).text, "");
  EXPECT_EQ(read_campaign(head(std::string(kBall) + "release_height_m = 30.0\n"), ball()).text, "");
}

TEST(FallLimits, SlowMotionIsToldAndTheLineCuresIt) {
  const auto told = read_campaign(head(kBall), ball(2.0));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("the time is stretched 2"));
  const auto cured = read_campaign(
      head(kBall, "[columns]\nt_s = { column = \"t_s\", unit = \"s as played\", scale = 0.5 }\n"), ball(2.0));
  EXPECT_TRUE(cured.recording.usable()) << cured.text;
  EXPECT_NEAR(cured.recording.t_s[2] - cured.recording.t_s[1], 0.005, 1e-9);
}

TEST(FallLimits, NoBodyIsBrakedWithAHundredTimesItsDrag) {
  const auto heavy =
      read_campaign(head("mass_kg = 145.0\ndiameter_m = 0.073\ndensity_kg_per_m3 = 1.2\n"), ball());
  EXPECT_FALSE(heavy.recording.usable());
  EXPECT_THAT(heavy.text, AllOf(HasSubstr("drag coefficient"), HasSubstr("no body has more than 2.3")));
}

TEST(FallLimits, AReleaseHeightInCentimetresIsTold) {
  const auto told = read_campaign(head(std::string(kBall) + "release_height_m = 500.0\n"), ball());
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("write release_height_m = 5 "));
}

// A press in which `row` gives time, depth and force of a row.
std::string press(const std::function<std::string(int)>& row) {
  std::string text = "time,force_N,foot_z_m\n";
  for (int i = 0; i < 100; ++i) text += row(i) + "\n";
  return text;
}
double noise_of(int i) { return 0.05 * std::sin(37.0 * i * i); }

TEST(PressLimits, ATimeInHoursIsToldAndTheLineCuresIt) {
  const std::string plate = "plant = \"intruder\"\n[every_trial]\nplate_diameter_m = 0.08\n[columns]\n";
  const auto hours = press([](int i) {
    return fmt::format("{:.9f},{:.3f},{:.5f}", 0.01 * i / 3600.0, 0.5 * i + noise_of(i), -3e-4 * i);
  });
  const auto told = read_campaign(plate + "t_s = \"time\"\n", hours);
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("t_s = { column = \"time\", unit = \"h\" }"));
  const auto cured = read_campaign(plate + "t_s = { column = \"time\", unit = \"h\" }\n", hours);
  EXPECT_TRUE(cured.recording.usable()) << cured.text;
}

TEST(PressLimits, AForceThatVariesInTheAirIsOfSomethingElse) {
  const std::string plate =
      "plant = \"intruder\"\n[every_trial]\nplate_diameter_m = 0.08\n[columns]\nt_s = \"time\"\n";
  const auto swing = press([](int i) {
    return fmt::format("{:.2f},{:.4f},{:.5f}", 0.01 * i, 12.0 * std::cos(0.2 * i) + noise_of(i),
                       -0.02 * std::sin(0.2 * i));
  });
  const auto told = read_campaign(plate, swing);
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("this is not the recording of a press"));
  const auto twice = press([](int i) {  // pushed in, lifted out and pushed in again
    const double depth = 0.02 * std::sin(0.1 * i);
    return fmt::format("{:.2f},{:.4f},{:.5f}", 0.01 * i, 1500.0 * std::max(0.0, depth) + noise_of(i), -depth);
  });
  EXPECT_TRUE(read_campaign(plate, twice).recording.usable());
}

// A body under a parachute that is recorded from 27 m/s on.
TEST(FallLimits, AFallIsAsFastAsItsReleaseIsSaidToBe) {
  std::string text = "t_s,height_m\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{:.2f},{:.3f}\n", 0.1 * i, 2500.0 - 2.7 * i);
  const std::string body = "mass_kg = 22.8\ndiameter_m = 0.15\ndensity_kg_per_m3 = 1.0\n";
  const auto unsaid = read_campaign(head(body), text);
  EXPECT_THAT(unsaid.text, HasSubstr("faster than a throw of 15 m/s"));
  EXPECT_THAT(unsaid.text, HasSubstr("write release_speed_mps = 27 into its [[trial]]"));
  const auto said = read_campaign(head(body + "release_speed_mps = 27.0\n"), text);
  EXPECT_EQ(said.text.find("faster than"), std::string::npos) << said.text;
  const auto too_fast = read_campaign(head(body + "release_speed_mps = 16.0\n"), text);
  EXPECT_THAT(too_fast.text, HasSubstr("1.5 times the stated release speed of 16 m/s"));
}

}  // namespace
}  // namespace sandhopper
