#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "campaign_folder.hpp"
#include "tools/terrain/campaign_analysis.hpp"

// Presses whose force was not tared.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Terrain of two presses that read `zero_N` above the surface and 52.5 N at the most beyond it.
std::string terrain(double zero_N, const std::string& columns = "") {
  CampaignFolder folder;
  for (const int noise : {7, 11}) {  // of each press its own
    std::string press = "t_s,foot_z_m,force_N\n";
    for (int i = 0; i < 200; ++i) {
      const double depth = 2e-4 * i - 0.005;
      press += fmt::format("{:.2f},{:.6f},{:.4f}\n", 0.01 * i, -depth,
                           1500.0 * std::max(0.0, depth) + zero_N + 0.02 * std::sin(noise * i * i));
    }
    folder.write(fmt::format("{}.csv", noise), press);
  }
  folder.write("campaign.toml",
               "plant = \"intruder\"\n" + columns +
                   "[every_trial]\nkind = \"press\"\nplate_diameter_m = 0.08\n[[trial]]\nfile = \"7.csv\"\n"
                   "[[trial]]\nfile = \"11.csv\"\n");
  const auto results = analyse_campaign(load_campaign(folder.path()), {});
  std::string text;
  for (const auto& line : report_on(results).lines) text += line + "\n";
  for (const auto& result : results.results)
    for (const auto& reason : result.ruled_out) text += reason + "\n";
  return text;
}

// The limit is 1 % of the largest force.
TEST(UntaredPress, GivesNoDepthLaw) {
  const auto told = terrain(12.0);
  EXPECT_THAT(told, Not(HasSubstr("Depth law of")));
  EXPECT_THAT(told, HasSubstr("force_N reads 12 N above the surface, and every law would hold it"));
  EXPECT_THAT(terrain(0.6), Not(HasSubstr("Depth law of")));
  EXPECT_THAT(terrain(0.4), HasSubstr("Depth law of 2 presses"));
}

TEST(UntaredPress, IsTakenIfUnitAndScaleAreStated) {
  EXPECT_THAT(terrain(12.0, "[columns]\nforce_N = { column = \"force_N\", unit = \"N\", scale = 1.0 }\n"),
              HasSubstr("Depth law of 2 presses"));
  EXPECT_THAT(
      terrain(12.0,
              "[columns]\nforce_N = { column = \"force_N\", unit = \"N\", scale = 1.0, offset = -12.0 }\n"),
      HasSubstr("K = 0.2984 N"));
}

}  // namespace
}  // namespace sandhopper
