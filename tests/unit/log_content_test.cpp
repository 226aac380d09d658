#include "firmware/log/log_content.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {
namespace {

class LogContentOf : public ::testing::Test {
 protected:
  LogContentOf()
      : file_(std::filesystem::temp_directory_path() /
              ("log_content_" + std::to_string(::getpid()) + ".mcap")) {}
  ~LogContentOf() override { std::filesystem::remove(file_); }

  template <class Record>
  LogContent of(std::string_view topic, int count) {
    std::filesystem::remove(file_);
    mcap::Writer writer(file_);
    const auto channel = writer.add_channel<Record>(topic);
    for (int i = 0; i < count; ++i) writer.write(channel, {}, Record{});
    writer.close();
    return content_of_log(file_);
  }
  std::filesystem::path file_;
};

TEST_F(LogContentOf, ATrialHasCycles) {
  const auto content = of<StepOutput>(topic::kOutput, 3);
  EXPECT_TRUE(content.is_of_this_firmware);
  EXPECT_TRUE(content.has_cycles);
  EXPECT_EQ(content.topics, "/output (3 messages)");
}

TEST_F(LogContentOf, ARecordingOfACalibrationHasNone) {
  const auto content = of<SensorFrame>(topic::kFrame, 2);
  EXPECT_TRUE(content.is_of_this_firmware);
  EXPECT_FALSE(content.has_cycles);
}

TEST_F(LogContentOf, AForeignLogIsNamedByItsTopics) {
  const auto content = of<Event>("/joint_state", 4);
  EXPECT_FALSE(content.is_of_this_firmware);
  EXPECT_EQ(content.topics, "/joint_state (4 messages)");
  EXPECT_TRUE(is_mcap(file_));
  std::ofstream(file_) << "t_s,force_N\n";
  EXPECT_FALSE(is_mcap(file_));
}

}  // namespace
}  // namespace sandhopper
