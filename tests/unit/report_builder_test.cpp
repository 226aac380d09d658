#include "tools/report/report_builder.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>

#include "config/dump.hpp"
#include "config/files.hpp"
#include "firmware/fault_check.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/topics.hpp"
#include "tools/report/log_report.hpp"

namespace sandhopper {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::NanSensitiveDoubleEq;

constexpr std::int64_t kStart_ns = 5'000'000'000'000;
constexpr std::int64_t kCycle_ns = 1'000'000;

StepOutput output_at(int cycle, State state = State::flight) {
  StepOutput output;
  output.time_ns = kStart_ns + cycle * kCycle_ns;
  output.state = state;
  output.estimate.leg_length_m = 0.3;
  output.estimate.foot_z_m = 0.001 * cycle;
  output.estimate.force_time_ns = output.time_ns - 2 * kCycle_ns;
  output.estimate.contact_force_N = 10.0 * cycle;
  return output;
}

const std::vector<double>& column(const ReportData& data, std::string_view name) {
  static const std::vector<double> kAbsent;
  for (const ReportColumn& candidate : data.columns) {
    if (candidate.name == name) return candidate.values;
  }
  return kAbsent;
}

TEST(ReportBuilder, WhatWasMeasuredEarlierStandsWhereItWasMeasured) {
  ReportBuilder builder;
  for (int cycle = 0; cycle < 4; ++cycle) builder.add(output_at(cycle));
  const ReportData data = builder.data();
  EXPECT_THAT(data.time_s, ElementsAre(DoubleNear(0.0, 1e-9), DoubleNear(0.001, 1e-9),
                                       DoubleNear(0.002, 1e-9), DoubleNear(0.003, 1e-9)));
  const double none = std::nan("");
  EXPECT_THAT(column(data, "estimate_contact_force_N"),
              ElementsAre(20.0, 30.0, NanSensitiveDoubleEq(none), NanSensitiveDoubleEq(none)));
  EXPECT_THAT(column(data, "estimate_foot_z_m"), ElementsAre(0.0, 0.001, 0.002, 0.003));
}

TEST(ReportBuilder, StaleSamplesAreNotDrawnAgain) {
  ReportBuilder builder;
  for (int cycle = 0; cycle < 3; ++cycle) {
    SensorFrame frame;
    frame.tof = {.time_ns = kStart_ns + 200'000, .height_m = 0.4, .fresh = cycle == 1};
    builder.add(frame);
    builder.add(output_at(cycle));
  }
  const double none = std::nan("");
  EXPECT_THAT(column(builder.data(), "tof_height_m"),
              ElementsAre(0.4, NanSensitiveDoubleEq(none), NanSensitiveDoubleEq(none)));
}

TEST(ReportBuilder, TimeCountsFromTheRelease) {
  ReportBuilder builder;
  for (int cycle = 0; cycle < 3; ++cycle) builder.add(output_at(cycle));
  Event released;
  released.time_ns = kStart_ns + kCycle_ns;
  released.kind = EventKind::released;
  builder.add(released);
  EXPECT_THAT(builder.data().time_s,
              ElementsAre(DoubleNear(-0.001, 1e-9), DoubleNear(0.0, 1e-9), DoubleNear(0.001, 1e-9)));
}

TEST(ReportBuilder, EachStateIsOnePhase) {
  ReportBuilder builder;
  for (int cycle = 0; cycle < 6; ++cycle)
    builder.add(output_at(cycle, cycle < 4 ? State::flight : State::compression));
  const ReportData data = builder.data();
  ASSERT_EQ(data.phases.size(), 2u);
  EXPECT_EQ(data.phases[0].name, "flight");
  EXPECT_DOUBLE_EQ(data.phases[0].to_s, data.phases[1].from_s);
  EXPECT_EQ(data.phases[1].name, "compression");
}

TEST(ReportBuilder, FaultIsSaidWithItsCure) {
  ReportBuilder builder;
  Event fault;
  fault.time_ns = kStart_ns;
  fault.kind = EventKind::fault_raised;
  fault.fault = Fault::imu_stale;
  builder.add(fault);
  EXPECT_THAT(builder.data().notes, ElementsAre(HasSubstr("data-ready line")));
}

TEST(ReportBuilder, AFaultIsSaidWithWhatWasSeenAndWhatIsAllowed) {
  const auto robot = to_node(load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config"));
  for (const auto& entry : kFaults) {
    if (entry.fault == Fault::none) continue;
    ReportBuilder builder;
    builder.set_robot(robot);
    Event event{.time_ns = kStart_ns, .kind = EventKind::fault_raised, .fault = entry.fault};
    event.values = {1.0, 1.0, 0.0, 0.0};
    builder.add(event);
    const auto reading = read_fault(event, &robot);
    EXPECT_THAT(builder.data().notes,
                ElementsAre(AllOf(HasSubstr(std::string(entry.name)), HasSubstr(": " + reading.value_text),
                                  HasSubstr("allowed: " + reading.limit_text))))
        << entry.name;
    EXPECT_THAT(builder.data().events.front().values, HasSubstr("allowed: " + reading.limit_text));
  }
}

TEST(ReportBuilder, StrideThatWasCutShortHasNoLiftoff) {
  ReportBuilder builder;
  builder.add(output_at(0));
  StrideResult stride;
  stride.summary.stride = 1;
  stride.summary.touchdown_ns = kStart_ns + 7 * kCycle_ns;
  stride.observer_ols.validity = Validity::too_few_samples;
  builder.add(stride);
  const ReportData data = builder.data();
  ASSERT_EQ(data.strides.size(), 1u);
  EXPECT_NEAR(data.strides[0].touchdown_s, 0.007, 1e-9);
  EXPECT_TRUE(std::isnan(data.strides[0].liftoff_s));
  EXPECT_TRUE(std::isnan(data.strides[0].observer_ols.value_N_per_m));
  EXPECT_EQ(data.strides[0].observer_ols.reason, "too few samples");
}

TEST(ReportBuilder, DepthCountsFromWhereTheFirstStrideMetTheSurface) {
  ReportBuilder builder;
  for (int cycle = 0; cycle < 5; ++cycle) {
    StepOutput output = output_at(cycle);
    output.estimate.force_depth_m = 0.003 + 0.001 * cycle;
    builder.add(output);
  }
  StrideResult stride;
  stride.summary.stride = 1;
  stride.summary.contact_ns = output_at(3).estimate.force_time_ns;
  builder.add(stride);
  EXPECT_THAT(column(builder.data(), "force_depth_m"),
              ElementsAre(DoubleNear(-0.001, 1e-12), DoubleNear(0.0, 1e-12), DoubleNear(0.001, 1e-12),
                          NanSensitiveDoubleEq(std::nan("")), NanSensitiveDoubleEq(std::nan(""))));
}

TEST(LogReport, LogIsReadWithItsFactsAndConfiguration) {
  const auto file = std::filesystem::temp_directory_path() / "sandhopper_log_report_test.mcap";
  {
    mcap::Writer writer(file);
    const auto channel = writer.add_channel<StepOutput>(topic::kOutput);
    writer.add_metadata("trial", {{"release_height_m", "0.061800"}});
    writer.attach("robot.toml", "application/toml", 0, mcap::bytes_of("[robot]\n"));
    for (int cycle = 0; cycle < 5; ++cycle) {
      const StepOutput output = output_at(cycle);
      writer.write(channel, {1'700'000'000'000'000'000 + cycle * kCycle_ns, output.time_ns}, output);
    }
    writer.close();
  }
  const ReportData data = report_data_from_log(file);
  std::filesystem::remove(file);
  EXPECT_EQ(data.time_s.size(), 5u);
  EXPECT_THAT(data.facts, testing::Contains(testing::Pair("date", "2023-11-14 22:13:20 UTC")));
  EXPECT_THAT(data.facts, testing::Contains(testing::Pair("release height", "61.8 mm")));
  EXPECT_EQ(data.configuration, "# robot.toml\n[robot]\n");
  EXPECT_THAT(data.notes, testing::IsEmpty());
}

TEST(LogReport, MissingRecordsAreToldWithTheirCause) {
  const auto file = std::filesystem::temp_directory_path() / "sandhopper_lost_records_test.mcap";
  const auto note = [&](const std::vector<LogGap>& found) {
    {
      mcap::Writer writer(file);
      const auto channel = writer.add_channel<StepOutput>(topic::kOutput);
      const auto gaps = writer.add_channel<LogGap>(topic::kGap);
      const StepOutput output = output_at(0);
      writer.write(channel, {output.time_ns, output.time_ns}, output);
      for (const auto& gap : found) writer.write(gaps, {}, gap);
      writer.close();
    }
    const ReportData data = report_data_from_log(file);
    std::filesystem::remove(file);
    return data.notes.empty() ? "" : data.notes.front();
  };
  EXPECT_EQ(note({{.lost = 600, .cause = LossCause::damaged}, {.lost = 2, .cause = LossCause::damaged}}),
            "602 records are missing: 602 were in damaged parts of the file from which hop recover made this "
            "one.");
  EXPECT_EQ(note({{.lost = 5, .cause = LossCause::ring_full}, {.lost = 1, .cause = LossCause::write_failed}}),
            "6 records are missing: the logger was too slow for 5; 1 could not be written (the disk was full "
            "or failed).");
  EXPECT_EQ(note({}), "");
}

}  // namespace
}  // namespace sandhopper
