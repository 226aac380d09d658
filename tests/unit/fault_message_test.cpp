#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "config/dump.hpp"
#include "config/files.hpp"
#include "firmware/fault_check.hpp"
#include "firmware/operator_text.hpp"

// The message of a fault must contain the measured and the allowed value.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;

ConfigNode robot_node() {
  return to_node(load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config"));
}

Event raised(Fault fault, double first, double second) {
  return {.kind = EventKind::fault_raised, .fault = fault, .values = {first, second, 0.0, 0.0}};
}

TEST(FaultMessage, AKeyNeverStandsInPlaceOfItsNumber) {
  const auto robot = robot_node();
  const std::regex keys(R"((limits|supervision|watchdog|estimator)\.[A-Za-z_.]*[A-Za-z])");
  for (const auto& entry : kFaults) {
    if (entry.fault == Fault::none) continue;
    const auto text = in_words(read_fault(raised(entry.fault, 1.0, 1.0), &robot));
    auto outside = std::regex_replace(text, std::regex(R"(\([^()]*\))"), "");
    EXPECT_FALSE(std::regex_search(outside, keys)) << entry.name << ": " << text;
  }
}

TEST(FaultMessage, ALimitThatDependsOnTheMomentIsThatOfTheEvent) {
  const auto robot = robot_node();
  EXPECT_EQ(
      in_words(read_fault(raised(Fault::tof_implausible, -0.21, 0.0345), &robot)),
      "jump of the height: -0.21 m; allowed: between plus and minus 0.0345 m, the way at 3 m/s since the "
      "last reading, plus 0.06 m (supervision.tof_jump_m)");
  EXPECT_THAT(in_words(read_fault(raised(Fault::load_cell_implausible, 81.0, 72.5), &robot)),
              HasSubstr("allowed: between plus and minus 72.5 N, half of the force, plus 60 N"));
  EXPECT_THAT(
      in_words(read_fault(raised(Fault::motor_position_jump, 1.0, 0.9), &robot)),
      HasSubstr("right motor: change of the position between two replies: 0.9 rad; allowed: the way at 40 "
                "rad/s (limits.motor_speed_radps) between them, plus"));
  EXPECT_THAT(in_words(read_fault(raised(Fault::motor_torque_limit, 0.0, 0.31), &robot)),
              HasSubstr("left motor: time at 2.8 N m (limits.motor_torque_Nm): 0.31 s"));
  EXPECT_THAT(in_words(read_fault(raised(Fault::motor_torque_limit, 0.0, 0.31), nullptr)),
              HasSubstr("time at limits.motor_torque_Nm: 0.31 s"));
}

TEST(FaultMessage, ACodeHasItsName) {
  EXPECT_EQ(in_words(read_fault(raised(Fault::drive_error, 0.0, 3.0), nullptr)),
            "left motor: error code of the drive: 3 (over-voltage); allowed: 0: no error");
  EXPECT_THAT(in_words(read_fault(raised(Fault::drive_error, 0.0, 77.0), nullptr)),
              HasSubstr("drive: 77; allowed"));
  EXPECT_THAT(in_words(read_fault(raised(Fault::transmit_refused, 4.0, 0.0), nullptr)),
              HasSubstr("4 (torque); allowed"));
}

TEST(FaultMessage, TheDaemonSaysItWithTheEvent) {
  const auto robot = robot_node();
  for (const auto kind : {EventKind::fault_raised, EventKind::disarm_refused})
    for (const auto& entry : kFaults) {
      if (entry.fault == Fault::none) continue;
      auto event = raised(entry.fault, 1.0, 112.3);
      event.kind = kind;
      const auto json = nlohmann::json::parse(operator_text(event, &robot));
      EXPECT_EQ(json.value("text", ""), in_words(read_fault(event, &robot))) << entry.name;
    }
  const auto hot = nlohmann::json::parse(operator_text(raised(Fault::motor_temperature, 0.0, 112.3), &robot));
  EXPECT_THAT(hot.value("text", ""),
              HasSubstr("left motor: temperature that the drive reports: 112.3 °C; allowed: "
                        "at most"));
  const auto armed = nlohmann::json::parse(operator_text(Event{.kind = EventKind::armed}, &robot));
  EXPECT_FALSE(armed.contains("text"));
}

}  // namespace
}  // namespace sandhopper
