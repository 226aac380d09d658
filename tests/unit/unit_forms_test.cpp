#include <gtest/gtest.h>

#include <tuple>

#include "tools/campaign/unit_check.hpp"
#include "tools/campaign/unit_text.hpp"
#include "tools/campaign/written_unit.hpp"

// Forms in which names state a unit: other brackets, factors, words, other alphabets.
namespace sandhopper {
namespace {

constexpr double kDegree = 0.017453292519943295;

TEST(UnitForms, AUnitIsReadInManyForms) {
  for (const auto& [name, dimension, to_si] : {std::tuple{"荷重（kN）", "force", 1e3},
                                               std::tuple{"荷重【kN】", "force", 1e3},
                                               std::tuple{"Force {kN}", "force", 1e3},
                                               std::tuple{"Force <kN>", "force", 1e3},
                                               std::tuple{"Force|kN", "force", 1e3},
                                               std::tuple{"Force: kN", "force", 1e3},
                                               std::tuple{"Force - kN", "force", 1e3},
                                               std::tuple{"F \\ kN", "force", 1e3},
                                               std::tuple{"Force [kN, filtered]", "force", 1e3},
                                               std::tuple{"ForcekN", "force", 1e3},
                                               std::tuple{"Fz_KN", "force", 1e3},
                                               std::tuple{"Force (Kn)", "force", 1e3},
                                               std::tuple{"Force kilonewton", "force", 1e3},
                                               std::tuple{"Force (kilograms)", "mass", 1.0},
                                               std::tuple{"Сила, кН", "force", 1e3},
                                               std::tuple{"Сила (кгс)", "force", 9.80665},
                                               std::tuple{"力（千克力）", "force", 9.80665},
                                               std::tuple{"Weg [1/100 mm]", "length", 1e-5},
                                               std::tuple{"t(1/1000s)", "time", 1e-3},
                                               std::tuple{"Время, мс", "time", 1e-3},
                                               std::tuple{"时间（毫秒）", "time", 1e-3},
                                               std::tuple{"ms since start", "time", 1e-3},
                                               std::tuple{"tms", "time", 1e-3},
                                               std::tuple{"theta°", "angle", kDegree},
                                               std::tuple{"Угол, град", "angle", kDegree},
                                               std::tuple{"角度（度）", "angle", kDegree},
                                               std::tuple{"Angle [pi rad]", "angle", 180 * kDegree},
                                               std::tuple{"torquemNm", "torque", 1e-3}}) {
    const auto unit = unit_in_name(name);
    ASSERT_TRUE(unit) << name;
    EXPECT_EQ(unit->dimension, dimension) << name;
    EXPECT_NEAR(unit->to_si / to_si, 1.0, 1e-9) << name;
  }
}

TEST(UnitForms, AFactorOrAnUnknownWordIsAnUnknownUnit) {
  for (const auto* name :
       {"Force (N, x1000)", "Force (N/1000)", "Force (N*1e-3)", "Force*1000", "Time /1000", "Load x10",
        "(s*1000)", "Depth (hundredths of mm)", "Angle (x pi)", "Force (kilo-N)", "Force (decanewton)",
        "Time (milli)", "力（磅）", "FzkN", "Angle (rad*1000)"}) {
    const auto unit = unit_in_name(name);
    ASSERT_TRUE(unit) << name;
    EXPECT_EQ(unit->dimension, "") << name << ": " << unit->text;
  }
}

// DIN 1313 writes a quantity divided by its unit: v/(m/s).
TEST(UnitForms, TheLongestUnitBehindASlashIsRead) {
  for (const auto& [name, dimension, to_si] :
       {std::tuple{"AngVel/rad/s", "angular rate", 1.0}, std::tuple{"ANGVEL/RAD/S", "angular rate", 1.0},
        std::tuple{"omega/rad s^-1", "angular rate", 1.0},
        std::tuple{"omega / (deg/s)", "angular rate", kDegree},
        std::tuple{"omega_rad/s", "angular rate", 1.0},
        std::tuple{"Drehzahl/1/min", "angular rate", 6 * kDegree}, std::tuple{"v/(m/s)", "speed", 1.0},
        std::tuple{"v/m/s", "speed", 1.0}, std::tuple{"speed mm/s", "speed", 1e-3},
        std::tuple{"a/m/s^2", "acceleration", 1.0}, std::tuple{"a/m s^-2", "acceleration", 1.0},
        std::tuple{"Druck/kN/m²", "pressure", 1e3}, std::tuple{"F/kN", "force", 1e3},
        std::tuple{"M/N m", "torque", 1.0}, std::tuple{"Sensor A/N", "force", 1.0},
        std::tuple{"joint/position/m", "length", 1.0}, std::tuple{"Time/s", "time", 1.0}}) {
    const auto unit = unit_in_name(name);
    ASSERT_TRUE(unit) << name;
    EXPECT_EQ(unit->dimension, dimension) << name << ": " << unit->text;
    EXPECT_NEAR(unit->to_si / to_si, 1.0, 1e-6) << name;
  }
}

TEST(UnitForms, AQuotientThatIsNotListedIsNoneOfItsParts) {
  for (const auto* name : {"c/N/m", "stiffness kN/m", "alpha/rad/s^3", "jerk_m/s^3", "f/1/s"}) {
    const auto unit = unit_in_name(name);
    ASSERT_TRUE(unit) << name;
    EXPECT_EQ(unit->dimension, "") << name << ": " << unit->text;
  }
}

TEST(UnitForms, RemarksAndLabelsAreNoUnits) {
  for (const auto* name : {"Force (left)", "Force (raw data)", "Load cell (500 N)", "Sensor x1", "Force/2",
                           "ch (1)", "Force (vertical)", "position", "torque", "height", "Load cell 10",
                           "axis10", "t", "t since trigger", "Force > limit"})
    EXPECT_FALSE(unit_in_name(name)) << name;
}

TEST(UnitForms, AUnitAloneDoesNotSettleAFactor) {
  const auto verdict = [](const char* name, const char* unit, std::optional<double> scale) {
    return check_unit({.column = name,
                       .channel = "force_N",
                       .row_unit = "",
                       .stated_unit = unit,
                       .scale = scale.value_or(1.0),
                       .has_scale = scale.has_value(),
                       .largest = 5.0});
  };
  EXPECT_NE(verdict("Force (N, x1000)", "N", {}).problem, "");
  EXPECT_EQ(verdict("Force (N, x1000)", "N, x1000", 1e3).problem, "");
  EXPECT_EQ(verdict("Force (N, x1000)", "N", 1.0).problem, "");
  EXPECT_EQ(verdict("Force (corr)", "N", {}).problem, "");
  EXPECT_EQ(verdict("Force (corr)", "kN", {}).scale, 1e3);
}

TEST(UnitForms, AUnitWithASlashMayBeStatedAsTheNameHasIt) {
  const auto verdict = [](const char* name, const char* unit) {
    return check_unit({.column = name,
                       .channel = "velocity_radps",
                       .row_unit = "",
                       .stated_unit = unit,
                       .scale = 1.0,
                       .has_scale = false,
                       .largest = 5.0});
  };
  EXPECT_EQ(verdict("AngVel/rad/s", "rad/s").problem, "");
  EXPECT_EQ(verdict("AngVel/deg/s", "deg/s").scale, kDegree);
  EXPECT_NE(verdict("AngVel/deg/s", "rad/s").problem, "");
  EXPECT_NE(verdict("Duration/s", "rad/s").problem, "");
}

}  // namespace
}  // namespace sandhopper
