#include "tools/campaign/name_factor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "read_campaign.hpp"
#include "tools/campaign/unit_check.hpp"

// Factors in a column's name, outside the brackets of its unit.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;

TEST(NameFactor, AFactorIsFound) {
  for (const auto* name :
       {"Force x10", "10*Force", "10 x Force", "Force*100", "Force × 10", "Force/10", "Force 10^1",
        "Force 10⁻¹", "Force 1e-3", "1/100 Force", "0.1*F", "Sensor/2", "Force^2", "Force²"})
    EXPECT_TRUE(name_holds_factor(name)) << name;
}

TEST(NameFactor, NamesMayHoldNumbers) {
  for (const auto* name :
       {"F10", "Force 1", "Load x", "Ch10", "x1", "x10", "Load x1", "Dev1/ai0", "Force A/B", "Run 3/12 Force",
        "2023/10/12 Force", "Force 2.5 filtered", "Cell 10", "F_10", "e10"})
    EXPECT_FALSE(name_holds_factor(name)) << name;
}

ColumnUnits bare_column(std::string column, std::string channel) {
  ColumnUnits units;
  units.column = std::move(column), units.channel = std::move(channel), units.largest = 80.0;
  return units;
}

// The factor does not tell its direction, so that unit = "N" alone does not settle it.
TEST(NameFactor, UnitAndScaleAreAskedFor) {
  for (const auto* column : {"Force x10 (N)", "10*Force (N)", "Force (N) 10^1", "Force/10 [N]", "F / 10 N"}) {
    const auto bare = bare_column(column, "force_N");
    EXPECT_THAT(check_unit(bare).problem, HasSubstr("a unit beside a factor")) << column;
    auto stated = bare;
    stated.stated_unit = "N";
    EXPECT_THAT(check_unit(stated).problem, HasSubstr("a unit beside a factor")) << column;
    stated.has_scale = true;
    EXPECT_EQ(check_unit(stated).problem, "") << column;
  }
  for (const auto* column :
       {"F10 (N)", "Force 1 (N)", "Load x (N)", "Ch10 (N)", "F / N", "Load Cell (500 N)"}) {
    const auto bare = bare_column(column, "force_N");
    EXPECT_EQ(check_unit(bare).problem, "") << column;
  }
}

TEST(NameFactor, AFactorAboveARowOfUnitsIsAskedFor) {
  auto units = bare_column("Depth x10", "foot_z_m");
  units.row_unit = "m";
  EXPECT_THAT(check_unit(units).problem, HasSubstr("Depth x10"));
  units.column = "Depth 10";
  EXPECT_EQ(check_unit(units).problem, "");
}

// scale = -0.001 is that of mm and of the sign, and tells nothing of the factor.
TEST(NameFactor, TheScaleOfTheUnitAloneIsNotEnough) {
  auto units = bare_column("Depth x10 (mm)", "foot_z_m");
  units.has_scale = true;
  for (const double scale : {1.0, -0.001, 0.001}) {
    units.scale = scale;
    EXPECT_THAT(check_unit(units).problem, HasSubstr("a unit beside a factor")) << scale;
  }
  units.scale = -0.0001;
  EXPECT_EQ(check_unit(units).problem, "");
}

// ISO 80000-1: F / 10^3 N is the number of 10^3 N.
TEST(NameFactor, AQuotientByAPowerOfTenIsRead) {
  for (const auto& [column, factor] :
       {std::pair{"F / 10³ N", 1000.0}, {"F/10^1 N", 10.0}, {"F / 10⁻¹ N", 0.1}}) {
    auto units = bare_column(column, "force_N");
    EXPECT_THAT(check_unit(units).problem, HasSubstr("does not fit")) << column;
    units.scale = factor, units.has_scale = true;
    EXPECT_EQ(check_unit(units).problem, "") << column;
  }
}

}  // namespace
}  // namespace sandhopper
