#include "config/motor_presets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string lines_of(std::string_view name) {
  for (const auto& preset : motor_presets())
    if (preset.name == name) return to_toml(preset);
  return "";
}

TEST(MotorPresets, EveryFigureHasItsSource) {
  for (const auto& preset : motor_presets())
    for (const auto* v :
         {&preset.velocity_range_radps, &preset.torque_range_Nm, &preset.motor_torque_constant_Nm_per_A,
          &preset.drive_reduction, &preset.pole_pairs})
      EXPECT_EQ(v->value.has_value(), !v->source.empty()) << preset.name;
}

TEST(MotorPresets, TorqueConstantsAreThoseOfTheOutput) {
  EXPECT_THAT(lines_of("AK80-9"), HasSubstr("\ntorque_constant_Nm_per_A = 0.819 "));
  EXPECT_THAT(lines_of("R80 KV110"), HasSubstr("\ntorque_constant_Nm_per_A = 0.0868 "));
}

TEST(MotorPresets, WhatIsNotPublishedIsNotInvented) {
  EXPECT_THAT(lines_of("R80 KV110"), HasSubstr("# torque_range_Nm: not published"));
  EXPECT_THAT(lines_of("R80 KV110"), Not(HasSubstr("\ntorque_range_Nm")));
  EXPECT_THAT(lines_of("AK10-9"), HasSubstr("# pole_pairs: not published"));
}

}  // namespace
}  // namespace sandhopper
