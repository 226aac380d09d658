#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "read_campaign.hpp"

// A body that is driven upward is no falling body in another unit.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Told flight(const std::function<double(double t_s)>& height_m, double until_s, const std::string& unit = "m",
            const std::string& set_up = "") {
  std::string text = "t_s,h\n";
  for (int i = 0; 0.01 * i < until_s; ++i)
    text += fmt::format("{:.2f},{:.6f}\n", 0.01 * i, height_m(0.01 * i));
  return read_campaign("plant = \"falling_body\"\n[columns]\nheight_m = { column = \"h\", unit = \"" + unit +
                           "\" }\n[every_trial]\nkind = \"drop\"\n" + set_up,
                       text);
}

// A water rocket: 100 m/s2 for 0.3 s, then a throw with 30 m/s.
double rocket_m(double t) {
  return t < 0.3 ? 50.0 * t * t : 4.5 + 30.0 * (t - 0.3) - 4.905 * (t - 0.3) * (t - 0.3);
}

TEST(RisingBody, ARocketIsTakenForOne) {
  const auto whole = flight(rocket_m, 4.5);
  EXPECT_FALSE(whole.recording.usable());
  EXPECT_THAT(whole.text, HasSubstr("it rises, and nothing in the belief drives it upward"));
  EXPECT_THAT(whole.text, HasSubstr("keep the rows after the motor has stopped"));
  EXPECT_THAT(whole.text, Not(HasSubstr("is in another unit")));
  const auto ascent = flight(rocket_m, 2.5);
  EXPECT_FALSE(ascent.recording.usable());
  EXPECT_THAT(ascent.text, HasSubstr("a motor drives it upward"));
  EXPECT_THAT(ascent.text, Not(HasSubstr("is in another unit")));
}

TEST(RisingBody, TheCureOfARocketIsTheThrowBehindItsMotor) {
  const auto thrown =
      flight([](double t) { return rocket_m(t + 0.3); }, 4.0, "m", "release_speed_mps = 30.0\n");
  EXPECT_TRUE(thrown.recording.usable()) << thrown.text;
}

TEST(RisingBody, AFallInAnotherUnitStillGetsItsUnit) {
  const auto fall = flight([](double t) { return 1000.0 - 4905.0 * t * t; }, 0.4);
  EXPECT_FALSE(fall.recording.usable());
  EXPECT_THAT(fall.text, HasSubstr("unit = \"mm\""));
  EXPECT_THAT(fall.text, Not(HasSubstr("it rises")));
  const auto downward = flight([](double t) { return 4.905 * t * t; }, 0.4);
  EXPECT_THAT(downward.text, HasSubstr("counts downward"));
  EXPECT_THAT(downward.text, Not(HasSubstr("drives it upward")));
}

}  // namespace
}  // namespace sandhopper
