#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "campaign_folder.hpp"
#include "tools/campaign/trial_recording.hpp"

// Every kind of bad input must be reported with file, line, column and a cure, and no more data may be left
// out than necessary.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using enum FindingKind;
using enum FindingSeverity;

TrialRecording read(const std::string& csv, const std::string& plant = "intruder",
                    const std::string& columns = "") {
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"" + plant + "\"\n" + columns + "[[trial]]\nfile = \"a.csv\"\n")
      .write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

struct Place {
  std::uint64_t line, column;
  bool operator==(const Place&) const = default;
};
void expect_finding(const TrialRecording& recording, FindingKind kind, FindingSeverity severity,
                    Place place) {
  const auto* finding = find(recording, kind);
  ASSERT_NE(finding, nullptr) << name_of(kind);
  EXPECT_EQ(finding->severity, severity) << to_string(*finding);
  EXPECT_EQ((Place{finding->line, finding->column}), place) << to_string(*finding);
  EXPECT_THAT(finding->file, ::testing::EndsWith("a.csv"));
  EXPECT_FALSE(finding->what.empty());
  EXPECT_EQ(recording.usable(), severity != trial_unusable);
}

// A push at 0.1 m/s; `cell` writes the force of each row. The data are in lines 2 to `rows + 1`.
std::string intrusion(int rows, const std::function<std::string(int)>& force,
                      const std::string& header = "t_s,foot_z_m,force_N") {
  std::string text = header + "\n";
  for (int i = 0; i < rows; ++i) text += fmt::format("{:.3f},{:.6f},{}\n", 1e-3 * i, -1e-4 * i, force(i));
  return text;
}
std::string live(int i) { return fmt::format("{:.4f}", 0.15 * i + 0.01 * std::sin(7.0 * i)); }

TEST(BadRecording, ACleanOneHasNoFinding) {
  const auto recording = read(intrusion(400, live));
  EXPECT_TRUE(recording.findings.empty()) << to_string(recording.findings.front());
  EXPECT_TRUE(recording.usable());
}

TEST(BadRecording, NonNumericCell) {
  const auto recording = read(intrusion(400, [](int i) { return i == 100 ? std::string("err") : live(i); }));
  expect_finding(recording, non_numeric_cell, note, {102, 17});
  EXPECT_TRUE(std::isnan(recording.channel("force_N")[100]));
  EXPECT_EQ(recording.rows(), 400U);
}

TEST(BadRecording, InfiniteCellsAreOneFindingWithTheirNumber) {
  const auto recording =
      read(intrusion(400, [](int i) { return i % 50 == 9 ? std::string("inf") : live(i); }));
  expect_finding(recording, nan_cell, note, {11, 17});
  EXPECT_EQ(recording.findings.size(), 1U);
  EXPECT_THAT(recording.findings[0].what, HasSubstr("and 7 more like it, the last in line 361"));
}

TEST(BadRecording, AColumnThatIsMostlyTextIsNotUsed) {
  const auto recording =
      read(intrusion(400, [](int i) { return i % 2 == 0 ? std::string("lost") : live(i); }));
  expect_finding(recording, non_numeric_cell, channel_unusable, {2, 17});
  EXPECT_FALSE(recording.has("force_N"));
  EXPECT_TRUE(recording.has("foot_z_m"));
}

TEST(BadRecording, AMeterThatWasMostlyBeyondItsRangeIsNotUsed) {
  const auto often = read(intrusion(400, [](int i) { return i % 2 == 0 ? std::string("OVL") : live(i); }));
  expect_finding(often, saturated, channel_unusable, {2, 17});
  EXPECT_FALSE(often.has("force_N"));
  const auto seldom = read(intrusion(400, [](int i) { return i % 50 == 0 ? std::string("OVL") : live(i); }));
  expect_finding(seldom, saturated, note, {2, 17});
  EXPECT_TRUE(seldom.has("force_N"));
}

TEST(BadRecording, ColumnsThatNobodyReadsMayHoldAnything) {
  const auto recording = read("t_s,force_N,operator\n0,1,anna\n1,2,ben\n2,2.5,NaN\n");
  EXPECT_TRUE(recording.findings.empty()) << to_string(recording.findings.front());
}

TEST(BadRecording, TimeGoingBackwards) {
  const auto recording =
      read("t_s,force_N\n0,1\n0.001,2\n0.0005,9\n0.002,3\n0.003,3.5\n0.004,4\n0.005,4.5\n");
  expect_finding(recording, time_backwards, note, {4, 1});
  EXPECT_EQ(recording.rows(), 6U);
}

TEST(BadRecording, AClockThatSlipsBackALittle) {
  std::string text = "t_s,force_N\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{:.3f},{}\n", 1e-3 * i - (i > 200 ? 0.03 : 0.0), live(i));
  const auto recording = read(text);
  expect_finding(recording, time_backwards, trial_unusable, {203, 1});
}

TEST(BadRecording, AClockSetBackForGood) {
  const auto recording = read("t_s,force_N\n10,1\n10.001,2\n0.0,9\n0.002,3\n");
  ASSERT_NE(find(recording, time_backwards), nullptr);
  EXPECT_EQ(find(recording, time_backwards)->line, 4U);
  EXPECT_FALSE(recording.usable()) << "half of its rows are gone";
}

TEST(BadRecording, DuplicateColumn) {
  const auto recording = read("t_s,force_N,force_N,foot_z_m\n0,1,2,3\n1,1,2,3\n");
  const auto* finding = find(recording, duplicate_column);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ((Place{finding->line, finding->column}), (Place{1, 13}));
  EXPECT_EQ(finding->severity, channel_unusable);
  EXPECT_FALSE(recording.has("force_N")) << "which of the two is right is not known";
  EXPECT_TRUE(recording.has("foot_z_m"));
  EXPECT_FALSE(read("t_s,t_s,force_N\n0,0,1\n1,1,2\n").usable());
}

TEST(BadRecording, UnknownUnit) {
  const auto kilo = read("t_s,foot_z_m,force_kN\n0,1,2\n1,2,3\n");
  expect_finding(kilo, unknown_unit, channel_unusable, {1, 14});
  EXPECT_THAT(kilo.findings[0].cure, HasSubstr("force_N = { column = \"force_kN\", scale = 1000 }"));
  EXPECT_FALSE(kilo.has("force_N"));
  const auto pounds = read("t_s,foot_z_m,force [lbf]\n0,1,2\n1,2,3\n");
  EXPECT_THAT(pounds.findings.at(0).cure, HasSubstr("scale = 4.448221615"));
  const auto counts = read("t_s,foot_z_m,force_raw\n0,1,2\n1,2,3\n");
  expect_finding(counts, unknown_unit, channel_unusable, {1, 14});
  const auto mapped = read("t_s,foot_z_m,force_kN\n0,1,2\n1,2,3\n", "intruder",
                           "[columns]\nforce_N = { column = \"force_kN\", scale = 1000.0 }\n");
  EXPECT_TRUE(mapped.findings.empty());
  EXPECT_EQ(mapped.channel("force_N")[1], 3000.0);
  const auto gravities = read("t_s,height_m,accel_g\n0,1,2\n1,2,3\n", "falling_body");
  EXPECT_THAT(gravities.findings.at(0).cure, HasSubstr("scale = 9.80665"));
}

TEST(BadRecording, TimeInAnotherUnitOrUnderAnotherName) {
  const auto milliseconds = read("t_ms,force_N\n0,1\n1,2\n");
  expect_finding(milliseconds, no_time, trial_unusable, {1, 1});
  EXPECT_THAT(milliseconds.findings[0].cure, HasSubstr("t_s = { column = \"t_ms\", scale = 0.001 }"));
  EXPECT_THAT(read("time,force_N\n0,1\n1,2\n").findings.at(0).cure, HasSubstr("column = \"time\""));
}

TEST(BadRecording, Gap) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 200; ++i)
    if (i < 80 || i > 120) text += fmt::format("{:.3f},{:.6f},{}\n", 1e-3 * i, -1e-4 * i, live(i));
  const auto recording = read(text);
  expect_finding(recording, gap, note, {82, 1});
  EXPECT_THAT(recording.findings[0].what, HasSubstr("0.042 s"));
}

TEST(BadRecording, Saturated) {
  const auto recording =
      read(intrusion(400, [](int i) { return i > 300 && i < 360 ? std::string("45.0000") : live(i % 300); }));
  expect_finding(recording, saturated, note, {303, 17});
  EXPECT_TRUE(recording.is_saturated("force_N", 301));
  EXPECT_FALSE(recording.is_saturated("force_N", 299));
  EXPECT_EQ(recording.saturation("force_N")->rows, 59U);
}

TEST(BadRecording, SaturatedFromAFifthOnIsNotUsed) {
  const auto recording =
      read(intrusion(400, [](int i) { return i > 200 && i < 390 ? std::string("30.0000") : live(i % 200); }));
  const auto* finding = find(recording, saturated);
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->severity, channel_unusable);
  EXPECT_FALSE(recording.has("force_N"));
}

TEST(BadRecording, StuckAltogether) {
  const auto recording = read(intrusion(400, [](int) { return std::string("3.25"); }));
  expect_finding(recording, stuck, channel_unusable, {2, 17});
  EXPECT_FALSE(recording.has("force_N"));
  EXPECT_TRUE(recording.has("foot_z_m"));
}

TEST(BadRecording, StuckFromSomeLineOn) {
  const auto recording = read(intrusion(600, [](int i) { return live(i < 200 ? 400 - i : 300); }));
  expect_finding(recording, stuck, channel_unusable, {202, 17});
  EXPECT_FALSE(recording.has("force_N"));
}

TEST(BadRecording, RestAndHeldValuesAndConstantChannelsAreNotStuck) {
  std::string text =
      "t_s,motor_left_position_rad,motor_left_temperature_C,command_left_torque_Nm,tof_height_m,load_cell_"
      "force_N,"
      "imu_foot_accel_z_mps2,phase\n";
  for (int i = 0; i < 1000; ++i) {
    const double moving = i < 400 ? 0.0 : 0.01 * (i - 400);  // motion of the leg; the body falls all the time
    text +=
        fmt::format("{:.3f},{:.4f},31,0,{:.4f},0,{:.4f},0\n", 1e-3 * i, 1.2 + std::round(100 * moving) / 100,
                    0.3 + 0.0001 * (i / 20 * 20), 9.81 + 0.02 * std::sin(1.7 * i) + moving);
  }
  const auto recording = read(text, "hopper");
  ASSERT_EQ(recording.findings.size(), 1U);
  EXPECT_EQ(recording.findings[0].kind, held_samples) << "of a sensor slower than the table";
  EXPECT_EQ(recording.findings[0].channel, "tof_height_m");
  EXPECT_EQ(recording.channels.size(), 7U);
}

// The encoder always reads one count; the speed sensor shows noise and `speed_radps` times a sine.
std::string axis_whose_encoder_reads_one_angle(double speed_radps) {
  std::string text = "t_s,position_rad,velocity_radps,torque_Nm\n";
  for (int i = 0; i < 1000; ++i) {
    const double noise = 0.02 * std::sin(2.1 * i * i);
    text += fmt::format("{:.3f},0.3876,{:.4f},{:.4f}\n", 1e-3 * i, speed_radps * std::sin(0.02 * i) + noise,
                        1.6 + 0.5 * noise);
  }
  return text;
}

TEST(BadRecording, AnAngleThatIsHeldIsNotStuck) {
  const auto recording = read(axis_whose_encoder_reads_one_angle(0.0), "rotary_axis");
  EXPECT_TRUE(recording.findings.empty()) << to_string(recording.findings.front());
  EXPECT_TRUE(recording.has("position_rad"));
}

TEST(BadRecording, AnAngleThatStaysWhileTheAxisTurnsIsStuck) {
  const auto recording = read(axis_whose_encoder_reads_one_angle(0.5), "rotary_axis");
  expect_finding(recording, stuck, channel_unusable, {2, 7});
  EXPECT_FALSE(recording.has("position_rad"));
}

TEST(BadRecording, ADwellOfThePrescribedMotionIsNotSaturation) {
  std::string text = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 900; ++i) {
    const int depth = std::min(i, 300) - std::max(0, i - 600);
    text += fmt::format("{:.3f},{:.6f},{:.4f}\n", 1e-3 * i, -1e-4 * depth, 0.15 * depth);
  }
  const auto recording = read(text);
  EXPECT_TRUE(recording.findings.empty()) << to_string(recording.findings.front());
}

TEST(BadRecording, MissingFile) {
  CampaignFolder folder;
  folder.write("campaign.toml", "plant = \"intruder\"\n[[trial]]\nfile = \"gone.csv\"\n");
  const auto campaign = load_campaign(folder.path());
  const auto recording = read_trial(campaign, campaign.trials.at(0));
  ASSERT_EQ(recording.findings.size(), 1U);
  EXPECT_EQ(recording.findings[0].kind, missing_file);
  EXPECT_EQ((Place{recording.findings[0].line, recording.findings[0].column}), (Place{3, 8}))
      << "in campaign.toml";
  EXPECT_FALSE(recording.usable());
}

TEST(BadRecording, WrongPlant) {
  const auto recording = read("t_s,motor_left_position_rad,tof_height_m\n0,1,2\n1,2,3\n");
  expect_finding(recording, wrong_plant, trial_unusable, {1, 5});
  EXPECT_THAT(recording.findings[0].what, HasSubstr("of plant \"hopper\", the campaign's is \"intruder\""));
}

TEST(BadRecording, NoKnownColumn) {
  const auto recording = read("t_s,Fz,depth\n0,1,2\n1,2,3\n");
  expect_finding(recording, unknown_column, trial_unusable, {1, 1});
  EXPECT_THAT(recording.findings[0].cure, HasSubstr("[columns]"));
}

TEST(BadRecording, AMappedColumnThatIsNotThere) {
  const auto recording = read("t_s,foot_z_m,Fx\n0,1,2\n1,2,3\n", "intruder", "[columns]\nforce_N = \"Fz\"\n");
  expect_finding(recording, missing_column, channel_unusable, {1, 1});
  EXPECT_THAT(recording.findings[0].cure, HasSubstr("did you mean \"Fx\""));
}

TEST(BadRecording, EmptyFileHeaderAloneAndNoHeader) {
  expect_finding(read(""), empty_file, trial_unusable, {1, 1});
  expect_finding(read("t_s,force_N\n"), empty_file, trial_unusable, {1, 1});
  expect_finding(read("0.0,1.5\n0.1,1.6\n"), no_header, trial_unusable, {1, 1});
}

TEST(BadRecording, RaggedRow) {
  const auto recording = read("t_s,force_N\n0,1\n1,2,3\n2\n3,4\n4,5\n5,6\n6,7\n7,7\n8,7\n9,7\n10,7\n11,9\n");
  expect_finding(recording, ragged_row, note, {3, 6});
  EXPECT_EQ(recording.rows(), 10U);
}

}  // namespace
}  // namespace sandhopper
