#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "read_campaign.hpp"

// Sensors that lose a direction, a factor or a row without a sign of it in their numbers.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

double noise(int i) { return std::sin(7.0 * i * i); }

// A swing of 0.7 rad whose speed is read as `speed` gives it.
std::string swing(const std::function<double(double)>& speed) {
  std::string csv = "t_s,position_rad,velocity_radps\n";
  for (int i = 0; i < 400; ++i) {
    const double t = 0.01 * i;
    csv += fmt::format("{:.2f},{:.6f},{:.5f}\n", t, 0.7 * std::cos(6.0 * t) + 2e-4 * noise(i),
                       speed(-4.2 * std::sin(6.0 * t)) + 0.003 * std::abs(noise(i)));
  }
  return read_campaign("plant = \"rotary_axis\"", csv).text;
}

TEST(LostSigns, ASpeedWithoutASignIsNamed) {
  EXPECT_THAT(swing([](double v) { return std::abs(v); }), HasSubstr("the speed has no sign"));
  EXPECT_THAT(swing([](double v) { return v; }), Not(HasSubstr("no sign")));
  EXPECT_THAT(swing([](double v) { return std::max(v, 0.0); }), Not(HasSubstr("no sign"))) << "cut off";
}

// A press to 40 mm and back, its force without one on the way out. The depth goes on at `back` times the
// speed of the foot.
std::string press_and_back(double back) {
  std::string csv = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 500; ++i) {
    const double depth_m = -0.010 + 2e-4 * std::min(i, 250) + back * 2e-4 * std::max(0, i - 250);
    csv += fmt::format("{:.2f},{:.6f},{:.4f}\n", 0.01 * i, -depth_m,
                       (i < 252 ? 1500.0 * std::max(0.0, depth_m) : 0.0) + 0.1 * noise(i));
  }
  return read_campaign("plant = \"intruder\"\n[every_trial]\nkind = \"press\"\nplate_diameter_m = 0.08", csv)
      .text;
}

TEST(LostSigns, ADepthThatCountsTheWayBackAsFurtherDepthIsNamed) {
  EXPECT_THAT(press_and_back(1.0), HasSubstr("counts the way back as further depth"));
  EXPECT_THAT(press_and_back(-1.0), Not(HasSubstr("the way back")));
  EXPECT_THAT(press_and_back(0.0), Not(HasSubstr("the way back"))) << "the foot was lifted off the sensor";
}

// A pendulum that is let go at rest, and its angle as a counter of one direction adds it up.
std::string pendulum(bool one_way, double start_radps = 0.0) {
  std::string csv = "t_s,position_rad\n";
  double angle = 0.7, speed = start_radps, counted = 0.7;
  for (int i = 0; i < 600; ++i) {
    csv += fmt::format("{:.2f},{:.6f}\n", 0.01 * i, (one_way ? counted : angle) + 2e-4 * noise(i));
    for (int k = 0; k < 10; ++k) {
      speed += 0.001 * (-40.0 * std::sin(angle) - 0.05 * speed);
      angle += 0.001 * speed;
      counted -= 0.001 * std::abs(speed);
    }
  }
  CampaignFolder folder;
  folder.write("nominal.toml", "[axis]\ninertia_kg_m2 = 0.02\ngravity_torque_Nm = 0.8\n")
      .write("campaign.toml",
             "plant = \"rotary_axis\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n")
      .write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  std::string text;
  for (const auto& finding : read_trial(campaign, campaign.trials.at(0)).findings)
    text += to_string(finding) + "\n";
  return text;
}

TEST(LostSigns, AnAngleThatOnlyGrowsInAFreeSwingIsNamed) {
  EXPECT_THAT(pendulum(true), HasSubstr("counts in one direction only"));
  EXPECT_THAT(pendulum(false), Not(HasSubstr("one direction")));
  EXPECT_THAT(pendulum(false, 20.0), Not(HasSubstr("one direction"))) << "it was pushed and turns round";
}

// A body that hangs for 0.5 s and falls; its accelerometer reads `gain` times what it should.
std::string fall(double gain) {
  std::string csv = "t_s,height_m,accel_mps2\n";
  for (int i = 0; i < 200; ++i) {
    const double t = 0.01 * i - 0.5, fallen_s = std::max(0.0, t);
    csv += fmt::format("{:.2f},{:.5f},{:.5f}\n", t, 12.0 - 4.905 * fallen_s * fallen_s + 2e-3 * noise(i),
                       gain * (t < 0.0 ? 9.81 : 0.0) + 0.05 * noise(i + 7));
  }
  return read_campaign("plant = \"falling_body\"", csv).text;
}

TEST(LostSigns, AnAccelerometerOfAnotherRangeIsNamedWithItsFactor) {
  EXPECT_THAT(fall(0.5), HasSubstr("the range of the sensor is another"));
  EXPECT_THAT(fall(0.5), HasSubstr("scale = 2"));
  EXPECT_THAT(fall(2.0), HasSubstr("scale = 0.5"));
  EXPECT_THAT(fall(1.0), Not(HasSubstr("the range of the sensor")));
  EXPECT_THAT(fall(0.9), Not(HasSubstr("the range of the sensor"))) << "a gain error is for the diagnosis";
}

// A press whose table has a column of that name; every tenth cell is `bad`.
std::string with_flag(const std::string& name, const std::string& good, const std::string& bad) {
  std::string csv = "t_s,foot_z_m,force_N," + name + "\n";
  for (int i = 0; i < 200; ++i)
    csv += fmt::format("{:.2f},{:.6f},{:.4f},{}\n", 0.01 * i, -2e-4 * i, 0.3 * i + 0.1 * noise(i),
                       i % 10 == 5 ? bad : good);
  return read_campaign("plant = \"intruder\"", csv).text;
}

TEST(LostSigns, RowsThatAColumnMarksAsBadAreCounted) {
  const auto valid = with_flag("Force_valid", "1", "0");
  EXPECT_THAT(valid, HasSubstr("Force_valid: marks 20 of 200 rows with 0"));
  EXPECT_THAT(valid, HasSubstr("select = { column = \"Force_valid\", value = 1 }"));
  EXPECT_THAT(with_flag("Status", "OK", "ERR"), HasSubstr("Status: marks 20 of 200 rows with err"));
  EXPECT_THAT(with_flag("quality flag", "0", "1"), HasSubstr("value = 0 }"));
  EXPECT_THAT(with_flag("sensor fault", "0", "3"), HasSubstr("marks 20 of 200 rows with 3"));
  for (const auto& told : {with_flag("Force_valid", "1", "1"), with_flag("Status", "OK", "OK"),
                           with_flag("tracking error", "0.25", "0.31"), with_flag("Status", "push", "hold"),
                           with_flag("stage", "1", "0")})
    EXPECT_THAT(told, Not(HasSubstr("rows with")));
}

}  // namespace
}  // namespace sandhopper
