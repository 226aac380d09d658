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
using testing::Not;

// A body that rests, falls 2 m with a little drag and lands; `reading`: the accelerometer's number for the
// true acceleration upward.
std::string fall(const std::function<double(double accel_mps2)>& reading) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::string text = "t_s,height_m,a (m/s^2)\n";
  double height = 2.0, speed = 0.0;
  for (int i = 0; i < 160; ++i) {
    const bool falls = i >= 30 && height > 0.0;
    const double accel = falls ? -9.81 + 0.02 * speed * speed : 0.0;
    if (!falls) speed = 0.0;
    text += fmt::format("{:.2f},{:.5f},{:.4f}\n", 0.01 * i, height + 1e-3 * noise(random),
                        reading(accel) + 0.02 * noise(random));
    height += speed * 0.01 + 0.5 * accel * 1e-4;
    speed += accel * 0.01;
  }
  return text;
}

constexpr std::string_view kHead =
    "plant = \"falling_body\"\n[every_trial]\nkind = \"drop\"\nmass_kg = 0.1\n[columns]\naccel_mps2 = {}\n";
std::string head(const std::string& mapping = "\"a (m/s^2)\"") {
  return fmt::format(fmt::runtime(kHead), mapping);
}

// Air slows a light ball until its accelerometer reads 1 m/s2. It hangs too short before its release for a
// stretch at rest, but the weight that it feels there shows the unit.
TEST(FallAcceleration, AShortRestBeforeTheFallShowsTheUnit) {
  const auto light_ball = [] {
    std::string text = "t_s,a (m/s^2)\n";
    for (int i = 0; i < 200; ++i) {
      const double felt = i < 5 ? 9.81 : 1.0 - std::exp(-0.05 * (i - 5));
      text += fmt::format("{:.3f},{:.4f}\n", 0.005 * i, felt);
    }
    return text;
  };
  EXPECT_EQ(read_campaign(head(), light_ball()).text.find("it is in g"), std::string::npos);
}

TEST(FallAcceleration, WithoutGravityIsToldAndTheLineCuresIt) {
  const auto without = fall([](double a) { return a; });
  const auto told = read_campaign(head(), without);
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, AllOf(HasSubstr("the acceleration without gravity"), HasSubstr("offset = 9.81"),
                               Not(HasSubstr("points downward"))));
  const auto cured =
      read_campaign(head("{ column = \"a (m/s^2)\", unit = \"m/s^2\", scale = 1, offset = 9.81 }"), without);
  EXPECT_TRUE(cured.recording.usable()) << cured.text;
}

TEST(FallAcceleration, CountedDownwardIsTold) {
  const auto told = read_campaign(head(), fall([](double a) { return -(a + 9.81); }));
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("scale = -1"));
  const auto both = read_campaign(head(), fall([](double a) { return -a; }));
  EXPECT_THAT(both.text, AllOf(HasSubstr("scale = -1"), HasSubstr("offset = 9.81")));
}

TEST(FallAcceleration, ASpecificForceIsRight) {
  EXPECT_EQ(read_campaign(head(), fall([](double a) { return a + 9.81; })).text, "");
}

}  // namespace
}  // namespace sandhopper
