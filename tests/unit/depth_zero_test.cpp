#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "read_campaign.hpp"

// A zero of the depth that is set anew in the bed, and a foot that is moved fast in the air above it.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kBefore = 150;  // rows before the zero is set

// A plate that sinks 0.2 mm a row from 10 mm above the surface; 1500 N/m. The depth jumps by `jump_m` after
// kBefore rows, at 20 mm; the foot itself moves so if `moves`.
std::string press_with_jump(double jump_m, double start_m = -0.010, bool moves = false) {
  std::string csv = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 300; ++i) {
    const double on_m = i < kBefore ? 0.0 : jump_m;
    const double depth_m = start_m + 2e-4 * i, pressed_m = depth_m + (moves ? on_m : 0.0);
    csv += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.01 * i, -(depth_m + on_m) + 1e-6 * std::sin(5.0 * i * i),
                       1500.0 * std::max(0.0, pressed_m) + 0.1 * std::sin(7.0 * i * i));
  }
  return csv;
}

const std::string kHead =
    "plant = \"intruder\"\n[every_trial]\nkind = \"intrusion\"\nplate_diameter_m = 0.08\n";

Told read_part(const std::string& csv, const std::string& keys) {
  CampaignFolder folder;
  folder.write("campaign.toml", kHead + "[[trial]]\nfile = \"a.csv\"\n" + keys).write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  Told told{read_trial(campaign, campaign.trials.at(0)), ""};
  for (const auto& finding : told.recording.findings) told.text += to_string(finding) + "\n";
  return told;
}

TEST(DepthZero, TheCureOfAZeroThatIsSetAnewHoldsTheOffset) {
  const auto csv = press_with_jump(-0.020);
  const auto whole = read_campaign(kHead, csv);
  EXPECT_FALSE(whole.recording.usable());
  const std::string from = "select = { from_line = 152 }", columns = "columns = { ";
  EXPECT_THAT(whole.text, HasSubstr(from));
  const auto at = whole.text.find(columns);
  ASSERT_NE(at, std::string::npos) << whole.text;
  const auto end = whole.text.find("} }", at);
  ASSERT_NE(end, std::string::npos) << whole.text;
  const auto second = read_part(csv, from + "\n" + whole.text.substr(at, end + 3 - at) + "\n");
  EXPECT_TRUE(second.recording.usable()) << second.text;
  EXPECT_NEAR(second.recording.channel("foot_z_m")[0], -0.020, 1e-5);
}

TEST(DepthZero, APartThatBeginsInTheBedAtDepthZeroIsRefused) {
  const auto without_offset = read_part(press_with_jump(-0.020), "select = { from_line = 152 }\n");
  EXPECT_FALSE(without_offset.recording.usable());
  EXPECT_THAT(without_offset.text, HasSubstr("its zero was set in the bed"));
  EXPECT_THAT(read_part(press_with_jump(0.0), "select = { from_line = 152 }\n").text, IsEmpty());
  EXPECT_THAT(read_part(press_with_jump(0.0), "select = { from_line = 52 }\n").text, IsEmpty());
}

TEST(DepthZero, AFootThatIsMovedFastInAirIsNoNewZero) {
  const auto in_air = read_campaign(kHead, press_with_jump(0.025, -0.060, true));
  EXPECT_TRUE(in_air.recording.usable()) << in_air.text;
  EXPECT_THAT(in_air.text, Not(HasSubstr("its zero was set anew")));
  EXPECT_THAT(read_campaign(kHead, press_with_jump(0.025, -0.020, true)).text,
              HasSubstr("its zero was set anew"));
}

}  // namespace
}  // namespace sandhopper
