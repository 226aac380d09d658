#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "firmware/log/csv_export.hpp"
#include "firmware/log/csv_import.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/record_layout.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "tools/plant/plant_truth.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;

TEST(RecordLayout, FindsEveryFieldWhereTheEncoderPutsIt) {
  StepOutput output;
  output.time_ns = -7;
  output.state = State::extension;
  output.stride = 3'000'000'000U;
  output.command.motor[1].torque_Nm = 1.25;
  output.estimate.normalised_innovation_squared[2] = 4.5;
  std::array<std::byte, cdr::size_of<StepOutput>()> bytes{};
  cdr::encode(output, bytes.data());
  mcap::Channel channel;
  channel.topic = "/output";
  channel.message_encoding = "cdr";
  channel.schema = {schema::message_name<StepOutput>(), "ros2msg", schema::text_of<StepOutput>()};
  const RecordLayout layout(channel);
  EXPECT_EQ(RecordLayout::integer(bytes, *layout.find("time_ns")), -7);
  EXPECT_EQ(RecordLayout::integer(bytes, *layout.find("stride")), 3'000'000'000);
  EXPECT_EQ(RecordLayout::number(bytes, *layout.find("command.motor.1.torque_Nm")), 1.25);
  EXPECT_EQ(RecordLayout::number(bytes, *layout.find("estimate.normalised_innovation_squared.2")), 4.5);
  const auto* state = layout.find("state");
  ASSERT_EQ(RecordLayout::integer(bytes, *state), 4);
  EXPECT_EQ(state->constants.at(4), "STATE_EXTENSION");
  const auto& last = layout.fields().back();
  EXPECT_EQ(last.offset + last.bytes, bytes.size());
  EXPECT_EQ(layout.find("no_such_field"), nullptr);
}

TEST(RecordLayout, RefusesWhatHasNoFixedSize) {
  mcap::Channel channel;
  channel.message_encoding = "cdr";
  channel.schema = {"p/msg/T", "ros2msg", "string name\n"};
  EXPECT_THROW(RecordLayout{channel}, mcap::Error);
  channel.schema.text = "float64[] values\n";
  EXPECT_THROW(RecordLayout{channel}, mcap::Error);
  channel.schema.text = "p/U u\n====\nMSG: p/U\np/U u\n";
  EXPECT_THROW(RecordLayout{channel}, mcap::Error);
}

class CsvExport : public ::testing::Test {
 protected:
  void SetUp() override {
    log_ =
        std::filesystem::temp_directory_path() / ("sandhopper_csv_" + std::to_string(::getpid()) + ".mcap");
    std::filesystem::remove(log_);
    mcap::Writer writer(log_);
    const auto frames = writer.add_channel<SensorFrame>("/frame");
    const auto outputs = writer.add_channel<StepOutput>("/output");
    const auto truths = writer.add_channel<PlantTruth>("/truth");
    const auto gaps = writer.add_channel<LogGap>("/gap");
    for (const int i : {0, 1, 2, 4}) {
      SensorFrame frame;
      frame.time_ns = 5'000'000'000 + std::int64_t{1'000'000} * i;
      frame.motor[0].position_rad = 0.1 + i;
      frame.motor[0].fresh = i != 1;
      frame.tof.height_m = 0.3;
      frame.tof.fresh = true;
      frame.tof.status = i == 2 ? 108 : 0;
      frame.load_cell.fresh = i == 2;
      StepOutput output;
      output.state = i < 2 ? State::armed : i == 2 ? State::flight : State::extension;
      output.estimate.load_cell_force_N = 1.0 / 3.0;
      output.estimate.body_z_m = 0.25;
      PlantTruth truth;
      truth.mocap_time_ns = i < 2 ? 1 : 2;
      truth.mocap_body_z_m = 0.5;
      const mcap::Stamp stamp{frame.time_ns, frame.time_ns};
      writer.write(frames, stamp, frame);
      writer.write(outputs, stamp, output);
      writer.write(truths, stamp, truth);
      if (i == 2) writer.write(gaps, stamp, LogGap{.lost = 3});
    }
    writer.close();
  }
  void TearDown() override { std::filesystem::remove(log_); }

  std::filesystem::path log_;
};

TEST_F(CsvExport, RowsHoldFreshSamplesOnly) {
  std::ostringstream text;
  const auto result = export_csv(log_, text);
  EXPECT_EQ(result.rows, 4U);
  EXPECT_EQ(result.lost_records, 3U);
  EXPECT_FALSE(result.truncated_at.has_value());

  std::istringstream back(text.str());
  const CsvTable table = read_csv(back);
  EXPECT_TRUE(table.issues.empty()) << describe("csv", table.issues.front());
  const auto cells = [&](std::string_view name) {
    const auto* column = table.find(name);
    if (column == nullptr) throw std::out_of_range(std::string(name));
    std::vector<std::string> shown;
    for (const double value : *column) shown.push_back(std::isnan(value) ? "" : std::to_string(value));
    return shown;
  };
  using Cells = std::vector<std::string>;
  EXPECT_EQ(cells("t_s"), (Cells{"0.000000", "0.001000", "0.002000", "0.004000"}));
  EXPECT_EQ(cells("motor_left_position_rad"), (Cells{"0.100000", "", "2.100000", "4.100000"}));
  EXPECT_EQ(cells("motor_left_temperature_C"), (Cells{"", "", "", ""}));
  EXPECT_EQ(cells("tof_height_m"), (Cells{"0.300000", "0.300000", "", "0.300000"}));
  EXPECT_EQ(cells("mocap_body_z_m"), (Cells{"0.500000", "", "0.500000", ""}));
  EXPECT_EQ(cells("phase"), (Cells{"", "", "0.000000", "2.000000"}));
  std::ostringstream named;
  export_csv(log_, named, {.phase_names = true});
  EXPECT_NE(named.str().find(",flight"), std::string::npos);
  EXPECT_NE(named.str().find(",extension"), std::string::npos);
  EXPECT_EQ((*table.find("load_cell_force_N"))[2], 1.0 / 3.0) << "every digit survives";
  EXPECT_EQ(table.find("estimate_body_z_m"), nullptr);
}

TEST_F(CsvExport, EstimatesAreWrittenOnRequest) {
  std::ostringstream text;
  export_csv(log_, text, {.optional_channels = true});
  std::istringstream back(text.str());
  const CsvTable table = read_csv(back);
  ASSERT_NE(table.find("estimate_body_z_m"), nullptr);
  EXPECT_EQ(table.find("estimate_body_z_m")->front(), 0.25);
  EXPECT_NE(table.find("imu_foot_gyro_z_radps"), nullptr);
}

TEST(CsvImport, SaysWhatIsWrongAndWhereAndReadsTheRest) {
  std::istringstream in(
      "t_s,a,b,a\n"
      "0,1,2,9\n"
      "0.001,x,2,9\n"
      "0.002,inf,,9\n"
      "0.0015,1,2,9\n"
      "0.003,1,2\n"
      ",1,2,9\n"
      "0.003,1,-inf,9\n"
      "0.003,1,2,9\n"
      "0.5,+1e3,2,9\n");
  const CsvTable table = read_csv(in);
  std::vector<std::string> found;
  for (const auto& issue : table.issues) found.push_back(describe("f.csv", issue));
  ASSERT_EQ(found.size(), 9U) << ::testing::PrintToString(found);
  EXPECT_THAT(found[0], HasSubstr("f.csv:1:9: a: a second column bears this name; rename one of them"));
  EXPECT_THAT(found[1], HasSubstr("f.csv:3:7: a: \"x\" is not a number"));
  EXPECT_THAT(found[2], HasSubstr("f.csv:4:7: a: \"inf\" is not a finite number"));
  EXPECT_THAT(found[3], HasSubstr("f.csv:5:1: t_s: time goes backwards, from 0.002 to 0.0015 s"));
  EXPECT_THAT(found[4], HasSubstr("f.csv:6:10: 3 cells where the header names 4"));
  EXPECT_THAT(found[5], HasSubstr("f.csv:7:1: t_s: no time"));
  EXPECT_THAT(found[6], HasSubstr("f.csv:8:9: b: \"-inf\" is not a finite number"));
  EXPECT_THAT(found[7], HasSubstr("f.csv:9:1: t_s: time stands still"));
  EXPECT_THAT(found[8], HasSubstr("f.csv:10:1: t_s: a gap of 0.497 s"));
  EXPECT_TRUE(table.has_errors());
  EXPECT_EQ(*table.find("t_s"), (std::vector<double>{0, 0.001, 0.002, 0.003, 0.003, 0.5}));
  EXPECT_EQ(table.find("a")->back(), 1'000.0);
  EXPECT_EQ(table.names, (std::vector<std::string>{"t_s", "a", "b"}));
}

TEST(CsvImport, ToleratesOtherSeparatorsQuotesAndLineEnds) {
  std::istringstream in("\xEF\xBB\xBF;\"t_s\"; Fz \r\n0;0;1.5\r\n1;1;\r\n");
  const CsvTable table = read_csv(in);
  EXPECT_TRUE(table.issues.empty()) << describe("f", table.issues.front());
  EXPECT_EQ(table.names, (std::vector<std::string>{"t_s", "Fz"}));
  EXPECT_EQ(table.find("Fz")->front(), 1.5);
  EXPECT_TRUE(std::isnan(table.find("Fz")->back()));
}

TEST(CsvImport, AnEmptyFileAndOneWithoutTimeAreErrors) {
  std::istringstream empty("");
  EXPECT_TRUE(read_csv(empty).has_errors());
  std::istringstream timeless("a,b\n1,2\n");
  EXPECT_TRUE(read_csv(timeless).has_errors());
  std::istringstream no_time_wanted("a,b\n1,2\n");
  EXPECT_FALSE(read_csv(no_time_wanted, {.time_column = ""}).has_errors());
}

TEST(CsvImport, IssuesAreCountedBeyondTheLimit) {
  std::string text = "t_s,a\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(i) + ",x\n";
  std::istringstream in(text);
  const CsvTable table = read_csv(in, {.max_issues = 10});
  EXPECT_EQ(table.issues.size(), 10U);
  EXPECT_EQ(table.more_issues, 90U);
}

}  // namespace
}  // namespace sandhopper
