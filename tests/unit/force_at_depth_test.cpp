#include "tools/campaign/force_at_depth.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "read_campaign.hpp"

// Presses whose depth and force never stand in one row.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kRows = 400;

// A press at 20 mm/s from 5 mm above a bed of 2000 N/m.
struct Press {
  double surface_m = 0.0, tare_N = 0.0, force_scale = 1.0, late_s = 0.0;

  static double depth_m(double t_s) { return 0.02 * t_s - 0.005; }
  std::string depth(int i) const { return fmt::format("{:.6f}", -(depth_m(0.005 * i) + surface_m)); }
  std::string force(int i) const {
    const double noise_N = 0.05 * std::sin(7.0 * i * i);
    const double into_m = std::max(0.0, depth_m(0.005 * i - late_s));
    return fmt::format("{:.6f}", force_scale * (2000.0 * into_m + tare_N + noise_N));
  }
};

constexpr std::string_view kHead =
    "plant = \"intruder\"\nmodel = \"nominal.toml\"\n[every_trial]\nkind = \"intrusion\"\n"
    "plate_diameter_m = 0.08\n";

std::string told(const CampaignFolder& folder) {
  const auto campaign = load_campaign(folder.path());
  std::string text;
  for (const auto& finding : read_trial(campaign, campaign.trials.at(0)).findings)
    text += to_string(finding) + "\n";
  return text;
}

// Depth in even rows, force in odd ones.
std::string in_turn(const Press& press) {
  CampaignFolder folder;
  std::string csv = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < kRows; ++i)
    csv += i % 2 == 0 ? fmt::format("{:.3f},{},\n", 0.005 * i, press.depth(i))
                      : fmt::format("{:.3f},,{}\n", 0.005 * i, press.force(i));
  folder.write("a.csv", csv).write("nominal.toml", "[terrain]\nstiffness_N_per_m = 1500.0\n");
  folder.write("campaign.toml", std::string(kHead) + "[[trial]]\nfile = \"a.csv\"\n");
  return told(folder);
}

// Depth and force in two files, at times that never coincide.
std::string in_two_files(const Press& press) {
  CampaignFolder folder;
  std::string depth = "t_s,foot_z_m\n", force = "t_s,force_N\n";
  for (int i = 0; i < kRows; ++i)
    (i % 2 == 0 ? depth : force) +=
        fmt::format("{:.3f},{}\n", 0.005 * i, i % 2 == 0 ? press.depth(i) : press.force(i));
  folder.write("a.csv", depth).write("b.csv", force);
  folder.write("nominal.toml", "[terrain]\nstiffness_N_per_m = 1500.0\n");
  folder.write("campaign.toml", std::string(kHead) +
                                    "[[trial]]\nfile = \"a.csv\"\n"
                                    "also = { file = \"b.csv\", columns = { t_s = \"t_s\" } }\n");
  return told(folder);
}

TEST(ForceAtDepth, ASoundPressStaysSilent) {
  EXPECT_THAT(in_turn({}), IsEmpty());
  EXPECT_THAT(in_two_files({}), IsEmpty());
}

TEST(ForceAtDepth, ChecksOfPressesRunOnRowsInTurn) {
  EXPECT_THAT(in_turn({.force_scale = -1.0}), HasSubstr("force_N: is negative where it is largest"));
  EXPECT_THAT(in_turn({.force_scale = 0.001}), HasSubstr("if the numbers are in kN"));
  EXPECT_THAT(in_turn({.force_scale = 1000.0}), HasSubstr("if the numbers are in mN"));
  EXPECT_THAT(in_turn({.surface_m = -0.010}), HasSubstr("the force rises 9.7 mm above depth 0"));
  EXPECT_THAT(in_turn({.surface_m = 0.010}), HasSubstr("the force begins at a depth of 10 mm"));
  EXPECT_THAT(in_turn({.tare_N = 20.0}), HasSubstr("reads 20 N on average above the surface"));
  EXPECT_THAT(in_turn({.late_s = 0.5}), HasSubstr("the force begins at a depth of 10 mm"));
}

TEST(ForceAtDepth, ChecksOfPressesRunOnTwoFiles) {
  const auto negative = in_two_files({.force_scale = -1.0});
  EXPECT_THAT(negative,
              AllOf(HasSubstr("b.csv:2:1: force_N: is negative where it is largest"),
                    HasSubstr("into the columns of its also = { … }"), Not(HasSubstr("[columns]"))));
  const auto shifted = in_two_files({.surface_m = 0.010});
  EXPECT_THAT(shifted, AllOf(HasSubstr("a.csv:2:1: foot_z_m: the force begins at a depth of 10 mm"),
                             HasSubstr("into [columns]")));
}

TEST(ForceAtDepth, GapsAndEndsOfTheDepthAreLeftOut) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  TrialRecording recording;
  std::vector<double> z(16, kNone);
  for (const int row : {1, 2, 4, 5, 6, 14}) z[static_cast<std::size_t>(row)] = -row;
  for (std::size_t row = 0; row < z.size(); ++row) recording.t_s.push_back(static_cast<double>(row));
  std::vector<double> force(z.size(), 5.0);
  force[4] = kNone;
  recording.channels = {{"foot_z_m", z}, {"force_N", force}};
  const ForceAtDepth pairs(recording);
  EXPECT_THAT(pairs.rows, ElementsAre(1, 2, 3, 5, 6, 14));
  EXPECT_THAT(pairs.z_m, ElementsAre(-1.0, -2.0, -3.0, -5.0, -6.0, -14.0));
}

}  // namespace
}  // namespace sandhopper
