#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <sstream>

#include "firmware/log/ros2_package.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {
namespace {

template <class Record>
mcap::Schema schema_of() {
  return {schema::message_name<Record>(), "ros2msg", schema::text_of<Record>()};
}

TEST(Ros2Package, EveryTypeIsAFileOfItsOwn) {
  const auto files = ros2_package({schema_of<SensorFrame>(), schema_of<StrideResult>()});
  EXPECT_TRUE(files.contains("msg/SensorFrame.msg"));
  EXPECT_TRUE(files.contains("msg/MotorSample.msg"));
  EXPECT_TRUE(files.contains("msg/StiffnessEstimate.msg"));
  EXPECT_THAT(files.at("msg/LoadCellSample.msg"), ::testing::StartsWith("int64 time_ns\n"));
  EXPECT_THAT(files.at("CMakeLists.txt"), ::testing::HasSubstr("project(sandhopper_msgs)"));
}

// Names of fields and constants by the rules of rosidl's own parser.
TEST(Ros2Package, NamesAreThoseRos2Allows) {
  const std::regex field(R"([a-zA-Z0-9_/]+(\[\d+\])? [a-z](_?[a-z0-9]+)*(  # .*)?)");
  const std::regex constant(R"(u?int\d+ [A-Z](_?[A-Z0-9]+)*=\d+)");
  for (const auto& [name, text] :
       ros2_package({schema_of<SensorFrame>(), schema_of<StepOutput>(), schema_of<Event>(),
                     schema_of<StrideResult>(), schema_of<LogGap>()})) {
    if (name.extension() != ".msg") continue;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
      EXPECT_TRUE(std::regex_match(line, field) || std::regex_match(line, constant)) << name << ": " << line;
  }
}

}  // namespace
}  // namespace sandhopper
