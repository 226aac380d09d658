#include "tools/trial/ground_export.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace sandhopper {
namespace {

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

// Value in a row by the name of the column.
std::string at(const std::vector<std::vector<std::string>>& rows, std::size_t row,
               const std::string& column) {
  for (std::size_t i = 0; i < rows.at(0).size(); ++i)
    if (rows[0][i] == column) return rows.at(row).at(i);
  return "no column " + column;
}

TEST(GroundExport, ProfileHasARowForEachStrideAndDepthWithUnitsInTheNames) {
  StrengthProfile profile;
  profile.stride = 2;
  profile.depth_min_m = 0.002;
  profile.depth_max_m = 0.021;
  for (std::size_t i = 0; i < kProfilePoints; ++i) {
    profile.force_N[i] = 2.0F * static_cast<float>(i + 1);
    profile.force_sd_N[i] = 0.5F;
  }
  for (std::size_t j = 0; j < kProfileCells; ++j)
    profile.tangent_N_per_m[j] = 100.0F * static_cast<float>(j + 1);
  std::ostringstream out;
  write_profile_csv({profile, profile}, out);
  const auto rows = cells_of(out.str());
  ASSERT_EQ(rows.size(), 1 + 2 * kProfilePoints);
  const std::size_t at_20mm = 16;  // the sixteenth half cell ends there
  EXPECT_EQ(at(rows, at_20mm, "depth_m"), "0.02");
  EXPECT_EQ(at(rows, at_20mm, "stride"), "2");
  EXPECT_EQ(at(rows, at_20mm, "force_N"), "32");
  EXPECT_NEAR(std::stod(at(rows, at_20mm, "force_ci95_high_N")), 32.98, 0.001);
  EXPECT_EQ(at(rows, at_20mm, "secant_N_per_m"), "1600");
  EXPECT_EQ(at(rows, at_20mm, "tangent_N_per_m"), "800");
  EXPECT_EQ(at(rows, at_20mm, "visited"), "1");
  EXPECT_EQ(at(rows, 1, "visited"), "0");
  EXPECT_EQ(at(rows, at_20mm + 1, "visited"), "0");
}

TEST(GroundExport, GroundHasEveryNumberWithItsInterval) {
  GroundSummary summary;
  summary.stride = 1;
  summary.shape = GroundShape::power_law;
  summary.exponent = {1.4, 1.2, 1.6};
  summary.line = {30.0, 13.3};
  summary.reloading_N_per_m = {40000.0, 20000.0, std::numeric_limits<double>::infinity()};
  std::ostringstream out;
  write_ground_csv({summary}, out);
  const auto rows = cells_of(out.str());
  ASSERT_EQ(rows.size(), 2u);
  ASSERT_EQ(rows[0].size(), rows[1].size());
  EXPECT_EQ(at(rows, 1, "shape"), "power_law");
  EXPECT_EQ(at(rows, 1, "exponent_ci95_high"), "1.6");
  EXPECT_EQ(at(rows, 1, "line_chi_squared"), "30");
  EXPECT_EQ(at(rows, 1, "reloading_N_per_m_ci95_high"), "inf");
  EXPECT_EQ(at(rows, 1, "line_valid"), "0");
}

}  // namespace
}  // namespace sandhopper
