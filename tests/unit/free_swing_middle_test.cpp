#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "read_campaign.hpp"

// The angle about which a pendulum swings.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string swing(double middle_rad, double width_rad, double loss = 0.002, const std::string& trial = "") {
  CampaignFolder folder;
  std::string csv = "t_s,position_rad\n";
  for (int i = 0; i < 600; ++i)
    csv += fmt::format(
        "{:.3f},{:.5f}\n", 0.01 * i,
        middle_rad + width_rad * std::exp(-loss * i) * std::cos(0.06 * i) + 1e-4 * std::sin(7.0 * i * i));
  folder.write("a.csv", csv);
  folder.write("nominal.toml", "[axis]\ninertia_kg_m2 = 0.02\ngravity_torque_Nm = 0.8\n");
  folder.write("campaign.toml",
               "plant = \"rotary_axis\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n" +
                   ("kind = \"motion\"\n" + trial));
  const auto campaign = load_campaign(folder.path());
  std::string text;
  for (const auto& finding : read_trial(campaign, campaign.trials.at(0)).findings)
    text += to_string(finding) + "\n";
  return text;
}

TEST(FreeSwingMiddle, AnAngleFromTheHorizontalOrFromUprightIsInDoubt) {
  EXPECT_THAT(swing(-1.5708, 0.8),
              AllOf(HasSubstr("swings about -1.57 rad, which is a quarter turn from hanging"),
                    HasSubstr("offset = 1.57079633")));
  EXPECT_THAT(swing(1.6, 0.3), HasSubstr("offset = -1.57079633"));
  EXPECT_THAT(swing(3.1416, 0.8),
              AllOf(HasSubstr("half a turn from hanging"), HasSubstr("offset = -3.14159265")));
}

TEST(FreeSwingMiddle, APendulumThatHangsStaysSilent) {
  for (const double width : {0.05, 0.8, 2.8}) EXPECT_THAT(swing(0.0, width), IsEmpty()) << width;
  EXPECT_THAT(swing(0.2, 0.8), IsEmpty());        // The zero was set by eye.
  EXPECT_THAT(swing(6.2832, 0.8), IsEmpty());     // One turn further it hangs, too.
  EXPECT_THAT(swing(0.0, 1.8, 0.01), IsEmpty());  // strong friction
  // It creeps to rest from the horizontal, and never swings.
  EXPECT_THAT(swing(1.5708, 0.0), IsEmpty());
  // A drive holds it there.
  EXPECT_THAT(swing(1.5708, 0.3, 0.002, "motor_enabled = true\n"), IsEmpty());
}

}  // namespace
}  // namespace sandhopper
