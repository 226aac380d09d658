#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "tests/unit/read_campaign.hpp"

namespace sandhopper {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A pendulum; `names` stand over time, angle and speed.
std::string swing(const std::string& names, double scale = 1.0) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0.0, 1e-3);
  std::string text = names + "\n";
  for (int i = 0; i < 600; ++i) {
    const double t = 0.005 * i;
    text += fmt::format("{:.3f},{:.5f},{:.5f}\n", t, scale * (0.5 * std::cos(6.0 * t) + noise(random)),
                        -3.0 * std::sin(6.0 * t) + noise(random));
  }
  return text;
}

constexpr const char* kAxis = "plant = \"rotary_axis\"\n[every_trial]\ninertia_kg_m2 = 0.02\n";

TEST(CrossedColumns, AngleAndSpeedUnderEachOthersName) {
  const auto crossed = swing("t_s,velocity_radps,position_rad");
  const auto told = read_campaign(kAxis, crossed);
  EXPECT_FALSE(told.recording.usable());
  EXPECT_THAT(told.text, AllOf(HasSubstr("the two columns are exchanged"), Not(HasSubstr("inches"))));
  const auto cured = read_campaign(
      std::string(kAxis) +
          "[columns]\nposition_rad = { column = \"velocity_radps\", unit = \"rad\", scale = 1 }\n"
          "velocity_radps = { column = \"position_rad\", unit = \"rad/s\", scale = 1 }\n",
      crossed);
  EXPECT_TRUE(cured.recording.usable()) << cured.text;
}

TEST(CrossedColumns, RightOnesAndAnotherUnitAreNotTakenForThem) {
  EXPECT_EQ(read_campaign(kAxis, swing("t_s,position_rad,velocity_radps")).text, "");
  const auto degrees = read_campaign(kAxis, swing("t_s,position_rad,velocity_radps", 57.29578));
  EXPECT_THAT(degrees.text, AllOf(HasSubstr("0.01745"), Not(HasSubstr("exchanged"))));
  const auto turned = read_campaign(kAxis, swing("t_s,position_rad,velocity_radps", -57.29578));
  EXPECT_THAT(turned.text, Not(HasSubstr("exchanged")));
}

TEST(CrossedColumns, OneColumnOfTwoQuantitiesIsRefused) {
  const auto table = swing("t_s,a,b");
  const auto twice =
      read_campaign(std::string(kAxis) +
                        "[columns]\nposition_rad = \"a\"\nvelocity_radps = { column = \"a\", scale = 1.0 }\n",
                    table);
  EXPECT_FALSE(twice.recording.usable());
  EXPECT_THAT(twice.text, HasSubstr("a column holds one quantity"));
  const auto once = read_campaign(std::string(kAxis) +
                                      "[columns]\nposition_rad = { column = \"a\", unit = \"rad\" }\n"
                                      "velocity_radps = { column = \"b\", unit = \"rad/s\" }\n",
                                  table);
  EXPECT_TRUE(once.recording.usable()) << once.text;
}

}  // namespace
}  // namespace sandhopper
