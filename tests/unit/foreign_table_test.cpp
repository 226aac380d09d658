#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "campaign_folder.hpp"
#include "tools/campaign/column_checks.hpp"
#include "tools/campaign/trial_recording.hpp"

// Tables in the formats of other programs, several variants of each.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;

struct Foreign {
  std::string plant = "rotary_axis";
  std::string campaign{};  // further lines before the trial
  std::string file = "a.csv";
};

TrialRecording read(const std::string& bytes, const Foreign& how = {}) {
  CampaignFolder folder;
  folder
      .write("campaign.toml",
             fmt::format("plant = \"{}\"\n{}\n[[trial]]\nfile = \"{}\"\n", how.plant, how.campaign, how.file))
      .write(how.file, bytes);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

std::string told(const TrialRecording& recording) {
  std::string text;
  for (const auto& finding : recording.findings) text += to_string(finding) + "\n";
  return text;
}

struct Writing {
  std::string header = "t_s,position_rad,velocity_radps,torque_Nm";
  char separator = ',';
  char decimal = '.';
  std::string row_end = "\n";
  int rows = 40;
};
// A table of a swinging axis in the notation `w`: time and three channels.
std::string swinging(const Writing& w = {}) {
  std::string text = w.header + w.row_end;
  for (int i = 0; i < w.rows; ++i) {
    const double t = 0.01 * i;
    std::string row =
        fmt::format("{:.5f}{}{:.5f}{}{:.5f}{}{:.5f}", t, w.separator, 0.3 * std::cos(4.0 * t), w.separator,
                    -1.2 * std::sin(4.0 * t), w.separator, 0.7 * std::sin(11.0 * t));
    for (char& c : row)
      if (c == '.') c = w.decimal;
    text += row + w.row_end;
  }
  return text;
}

void expect_swing(const TrialRecording& recording) {
  ASSERT_TRUE(recording.usable()) << told(recording);
  ASSERT_EQ(recording.rows(), 40U) << told(recording);
  ASSERT_TRUE(recording.has("position_rad") && recording.has("torque_Nm")) << told(recording);
  EXPECT_NEAR(recording.t_s[10], 0.1 + recording.t_s[0], 1e-6);
  EXPECT_NEAR(recording.channel("position_rad")[10], 0.3 * std::cos(0.4), 1e-5);
  EXPECT_NEAR(recording.channel("torque_Nm")[10], 0.7 * std::sin(1.1), 1e-5);
}

TEST(ForeignTable, RemarksAboveTheNamesArePassedOver) {
  expect_swing(read("# Test started at Thu Apr 22 2021\n# kt = 0.1\n" + swinging()));
  expect_swing(read("% MATLAB export, kt = 0.1\n\n" + swinging()));
  expect_swing(read("// rig 7\n// operator: ann, ben, cem, dora\n" + swinging()));
  expect_swing(read("LabVIEW Measurement\t\nWriter_Version\t2\n***End_of_Header***\t\n\n" + swinging()));
}

TEST(ForeignTable, InstrumentHeadersArePassedOverAndSaid) {
  const auto recording = read(
      "Instrument;Zwick\nDate;13.09.2023\nSpeed;5,0;mm/min\n\n" +
      swinging({.header = "t_s;position_rad;velocity_radps;torque_Nm", .separator = ';', .decimal = ','}));
  expect_swing(recording);
  EXPECT_THAT(told(recording), HasSubstr("a.csv:5:1: the names of the columns stand in line 5"));
  EXPECT_THAT(told(recording), HasSubstr("decimal comma"));
  expect_swing(read("sep=,\n" + swinging()));
  expect_swing(read("9/13/2023  20:41:18\nAltitude : 21.0\nPlate Diameter: 4.00cm\n" + swinging()));
}

// Facts above the names may have as many cells as a row, and numbers in them.
TEST(ForeignTable, AShorterRecordingBesideALongerOneEndsWhereItsTimesDo) {
  const auto with_times = [](int from, int to) {
    std::string text = "t1,angle1,t2,angle2\n";
    for (int i = 0; i < 60; ++i)
      text +=
          fmt::format("{:.2f},{:.5f},", 0.01 * i, 0.3 * std::cos(0.04 * i)) +
          (i < from || i >= to ? fmt::format("{:.2f},{:.5f}\n", 0.01 * i, 0.2 * std::cos(0.04 * i)) : ",\n");
    return read(text, {.campaign = "[columns]\nt_s = \"t2\"\nposition_rad = \"angle2\"\n"});
  };
  const auto shorter = with_times(25, 60);
  EXPECT_TRUE(shorter.usable() && shorter.rows() == 25u) << told(shorter);
  EXPECT_THAT(told(shorter), HasSubstr("ends with line 26; the 35 rows below it have no time"));
  EXPECT_THAT(told(with_times(10, 45)), HasSubstr("35 of 60 rows had to be left out"));
}

TEST(ForeignTable, TheNamesStandAboveTheRowsAndNotAboveTheFacts) {
  const auto swing =
      swinging({.header = "t_s;position_rad;velocity_radps;torque_Nm", .separator = ';', .decimal = ','});
  expect_swing(
      read("Drive;Firmware 3.12;Trace\nDate;14.03.2023;Time;10:50\nTrial;1;Sine 0,5 Hz\nRate;500;Hz\n"
           "Encoder;16384;counts\n\n" +
           swing));
  expect_swing(read("Rate;500;Gain;2\nRange;3;Offset;0\nMass;1,5;Zero;0\nTrial;7;Day;2\n" + swing));
  std::string press = "Operator;Ann\nRate;500\nGain;2\nRange;1000\nOffset;0\nt_s;force_N\n";
  for (int i = 0; i < 20; ++i) press += fmt::format("{};{}\n", i, 2 * i + 1);
  const auto two = read(press, {.plant = "intruder"});
  ASSERT_TRUE(two.has("force_N")) << told(two);
  EXPECT_EQ(two.rows(), 20U);
}

TEST(ForeignTable, WhatTheOwnerStatesIsNotSaidAgain) {
  const auto text =
      "Rig;7\n" +
      swinging({.header = "t_s;position_rad;velocity_radps;torque_Nm", .separator = ';', .decimal = ','});
  EXPECT_THAT(told(read(text)), HasSubstr("stand in line 2, the line above is passed over; numbers have"));
  const auto partly = told(read(text, {.campaign = "[format]\nheader_line = 2\n"}));
  EXPECT_THAT(partly, HasSubstr("numbers have a decimal comma"));
  EXPECT_THAT(partly, testing::Not(HasSubstr("stand in line")));
  EXPECT_EQ(told(read(text, {.campaign = "[format]\nheader_line = 2\ndecimal = \",\"\n"})), "");
}

// Names that are repeated within a table do not make its first part facts.
TEST(ForeignTable, AWordInEveryRowIsNoFactAboveTheNames) {
  std::string text;
  for (const int rows : {5, 20}) {
    text += "trial;t_s;force_N\n";
    for (int i = 0; i < rows; ++i) text += fmt::format("run{};{};{}\n", rows, i + rows, 2 * i + 1);
  }
  const auto both = read(text, {.plant = "intruder"});
  EXPECT_THAT(told(both), testing::Not(HasSubstr("stand in line")));
}

TEST(ForeignTable, TheMarkOfARemarkBeforeTheNamesIsNoPartOfThem) {
  expect_swing(read(swinging({.header = "# t_s,position_rad,velocity_radps,torque_Nm"})));
  expect_swing(read(swinging({.header = "#t_s,position_rad,velocity_radps,torque_Nm"})));
  expect_swing(
      read(swinging({.header = "% t_s\tposition_rad\tvelocity_radps\ttorque_Nm", .separator = '\t'})));
  expect_swing(read(swinging({.header = "# t_s position_rad velocity_radps torque_Nm", .separator = ' '})));
  expect_swing(read(swinging({.header = "# t_s,position_rad,velocity_radps,torque_Nm"}),
                    {.campaign = "[columns]\nt_s = { column = \"# t_s\" }\n"}));
}

TEST(ForeignTable, DecimalCommasAreRead) {
  const std::string header = "t_s;position_rad;velocity_radps;torque_Nm";
  expect_swing(read(swinging({.header = header, .separator = ';', .decimal = ','})));
  expect_swing(read(swinging(
      {.header = "t_s\tposition_rad\tvelocity_radps\ttorque_Nm", .separator = '\t', .decimal = ','})));
  expect_swing(read(swinging({.header = header, .separator = ';', .decimal = ',', .row_end = ";\r\n"})));
  const auto quoted = read(
      "t_s,force_N,foot_z_m\n\"0,0\",\"1,5\",\"-0,01\"\n\"0,1\",\"2,5\",\"-0,02\"\n\"0,2\",\"3,25\",\"-0,"
      "03\"\n",
      {.plant = "intruder"});
  ASSERT_TRUE(quoted.usable()) << told(quoted);
  EXPECT_EQ(quoted.channel("force_N")[2], 3.25);
}

TEST(ForeignTable, ThousandsAreNoDecimals) {
  const auto german = read("t_s;force_N\n0,0;1.234,5\n0,1;2.345,5\n0,2;987,5\n", {.plant = "intruder"});
  EXPECT_EQ(german.channel("force_N")[0], 1234.5) << told(german);
  const auto english =
      read("t_s,force_N\n0.0,\"1,234.5\"\n0.1,\"2,345.5\"\n0.2,987.5\n", {.plant = "intruder"});
  EXPECT_EQ(english.channel("force_N")[1], 2345.5) << told(english);
  const auto swiss = read("t_s;force_N\n0.0;1'234.5\n0.1;2'345.5\n0.2;987.5\n", {.plant = "intruder"});
  EXPECT_EQ(swiss.channel("force_N")[1], 2345.5) << told(swiss);
}

TEST(ForeignTable, ACommaThatMayMeanEitherIsAsked) {
  const std::string text = "t_s;force_N\n0;1,234\n1;2,345\n2;3,456\n";
  const auto asked = read(text, {.plant = "intruder"});
  EXPECT_FALSE(asked.usable());
  EXPECT_THAT(told(asked), HasSubstr("[format] decimal"));
  const auto told_so = read(text, {.plant = "intruder", .campaign = "[format]\ndecimal = \",\"\n"});
  EXPECT_EQ(told_so.channel("force_N")[0], 1.234) << told(told_so);
  const auto otherwise =
      read(text, {.plant = "intruder", .campaign = "[format]\nthousands = \",\"\ndecimal = \".\"\n"});
  EXPECT_EQ(otherwise.channel("force_N")[0], 1234.0) << told(otherwise);
}

std::string utf16(const std::string& text, bool big_endian, bool mark) {
  std::string out = !mark ? "" : big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) big_endian ? (out += '\0', out += c) : (out += c, out += '\0');
  return out;
}

TEST(ForeignTable, Utf16IsReadAndSaid) {
  const Writing tabs{
      .header = "t_s\tposition_rad\tvelocity_radps\ttorque_Nm", .separator = '\t', .row_end = "\r\n"};
  for (const auto& bytes : {utf16(swinging(tabs), false, true), utf16(swinging(tabs), true, true),
                            utf16(swinging(), false, false)}) {
    const auto recording = read(bytes);
    expect_swing(recording);
    EXPECT_THAT(told(recording), HasSubstr("UTF-16"));
    EXPECT_EQ(told(recording).find('\0'), std::string::npos);
  }
}

TEST(ForeignTable, Windows1252IsReadAndSaid) {
  const std::string map = "[columns]\nposition_rad = { column = \"Winkel [°]\", scale = 0.0174532925 }\n";
  const auto recording = read(swinging({.header = "t_s,Winkel [\xB0],v,torque_Nm"}), {.campaign = map});
  ASSERT_TRUE(recording.usable()) << told(recording);
  EXPECT_NEAR(recording.channel("position_rad")[0], 0.3 * 0.0174532925, 1e-9);
  EXPECT_THAT(told(recording), HasSubstr("Windows-1252"));
  const auto micro =
      read("Zeit [\xB5s],force_N\n0,1\n1000,2\n2000,3\n",
           {.plant = "intruder", .campaign = "[columns]\nt_s = { column = \"Zeit [µs]\", scale = 1e-6 }\n"});
  EXPECT_NEAR(micro.t_s.at(2), 2e-3, 1e-12) << told(micro);
  const auto umlaut = read("t_s,H\xF6he (mm)\n0,1000\n0.1,950\n0.2,800\n",
                           {.plant = "falling_body",
                            .campaign = "[columns]\nheight_m = { column = \"Höhe (mm)\", unit = \"mm\" }\n"});
  EXPECT_NEAR(umlaut.channel("height_m")[1], 0.95, 1e-12) << told(umlaut);
  expect_swing(read("\xEF\xBB\xBF" + swinging()));
}

TEST(ForeignTable, WordsForNoSampleAreNoSamples) {
  const auto recording = read(
      "t_s,force_N,foot_z_m\n0,NaN,-0.01\n0.1,nan,-\n0.2,#N/A,-0.02\n0.3,,NULL\n0.4,4,-0.04\n0.5,--,-0.05\n",
      {.plant = "intruder"});
  EXPECT_TRUE(recording.findings.empty()) << told(recording);
  EXPECT_TRUE(std::isnan(recording.channel("force_N")[1]));
  EXPECT_EQ(recording.channel("force_N")[4], 4.0);
  const auto stated = read("t_s,force_N\n0,1\n0.1,-999\n0.2,OVER\n0.3,4\n",
                           {.plant = "intruder", .campaign = "[format]\nno_sample = [\"OVER\", \"-999\"]\n"});
  EXPECT_TRUE(stated.findings.empty()) << told(stated);
  EXPECT_TRUE(std::isnan(stated.channel("force_N")[1]));
  EXPECT_TRUE(std::isnan(stated.channel("force_N")[2]));
  EXPECT_EQ(stated.channel("force_N")[3], 4.0);
}

TEST(ForeignTable, WhatIsStatedOfTimesIsObeyed) {
  const std::string clock = "Time,force_N\n00:01,1\n00:02,2\n00:04,3\n";
  const std::string time = "[columns]\nt_s = \"Time\"\n";
  for (const auto& [word, last_s] : {std::pair{"mm:ss", 3.0}, std::pair{"hh:mm", 180.0}}) {
    const auto got = read(
        clock, {.plant = "intruder", .campaign = fmt::format("[format]\nclock = \"{}\"\n{}", word, time)});
    ASSERT_TRUE(got.usable()) << told(got);
    EXPECT_NEAR(got.t_s[2] - got.t_s[0], last_s, 1e-9);
  }
  const std::string dates = "Time,force_N\n03/04/2023 23:59:59,1\n04/04/2023 00:00:01,2\n";
  for (const auto& [first, last_s] : {std::pair{"true", 2.0}, std::pair{"false", 30 * 86400.0 + 2}}) {
    const auto got = read(
        dates, {.plant = "intruder", .campaign = fmt::format("[format]\nday_first = {}\n{}", first, time)});
    ASSERT_TRUE(got.usable()) << told(got);
    EXPECT_NEAR(got.t_s[1] - got.t_s[0], last_s, 1e-3);
  }
  const auto even =
      read("force_N,foot_z_m\n1,0\n\n2,-0.1\n\nbroken\n\n3,-0.3\n\n4,-0.4\n\n5,-0.5\n\n6,-0.6\n",
           {.plant = "intruder", .campaign = "[format]\nrow_every_s = 0.5\n"});
  ASSERT_TRUE(even.usable()) << told(even);
  EXPECT_EQ(even.t_s, (std::vector<double>{0.0, 0.5, 1.5, 2.0, 2.5, 3.0}))
      << "a row that is left out leaves a gap";
}

TEST(ForeignTable, LinesOfAFileAreSelected) {
  std::string two = "t_s,force_N\n";
  for (int i = 0; i < 12; ++i) two += fmt::format("{},{}\n", i, i + 1);
  two += "t_s,force_N\n";
  for (int i = 0; i < 12; ++i) two += fmt::format("{},{}\n", i, 10 * (i + 1));
  CampaignFolder folder;
  folder
      .write(
          "campaign.toml",
          "plant = \"intruder\"\n[[trial]]\nfile = \"a.csv\"\nselect = { to_line = 13 }\n[[trial]]\nfile = "
          "\"a.csv\"\nselect = { from_line = 15, to_line = 25 }\n")
      .write("a.csv", two);
  const auto campaign = load_campaign(folder.path());
  ASSERT_EQ(campaign.trials.size(), 2U);
  const auto first = read_trial(campaign, campaign.trials[0]),
             second = read_trial(campaign, campaign.trials[1]);
  ASSERT_TRUE(first.usable()) << told(first);
  EXPECT_EQ(first.channel("force_N").back(), 12.0);
  ASSERT_TRUE(second.usable()) << told(second);
  EXPECT_EQ(second.rows(), 11U);
  EXPECT_EQ(second.channel("force_N").front(), 10.0);
}

TEST(ForeignTable, PhasesMayHaveTheirNames) {
  std::string text = "t_s,phase,load_cell_force_N\n";
  const std::array<const char*, 5> names{"armed", "flight", "compression", "Extension", "soft_stop"};
  for (int i = 0; i < 5; ++i)
    text += fmt::format("{},{},{}\n", 0.001 * i, names[static_cast<std::size_t>(i)], i);
  const auto named = read(text, {.plant = "hopper"});
  ASSERT_TRUE(named.has("phase")) << told(named);
  const auto phase = named.channel("phase");
  EXPECT_TRUE(std::isnan(phase[0]) && std::isnan(phase[4]));
  EXPECT_EQ((std::vector<double>{phase[1], phase[2], phase[3]}), (std::vector<double>{0.0, 1.0, 2.0}));
  const auto stance =
      read("t_s,phase,load_cell_force_N\n0,flight,0\n0.001,stance,3\n0.002,stance,4\n", {.plant = "hopper"});
  EXPECT_EQ(stance.channel("phase")[1], 1.0) << told(stance);
  EXPECT_THAT(told(stance), HasSubstr("taken for compression"));
}

TEST(ForeignTable, AnUnknownPhaseIsAnErrorThatListsTheNames) {
  const std::string text = "t_s,phase,load_cell_force_N\n0,flight,0\n0.001,landing,3\n0.002,extension,4\n";
  const auto unknown = read(text, {.plant = "hopper"});
  EXPECT_FALSE(unknown.usable());
  EXPECT_THAT(told(unknown), HasSubstr("a.csv:3:7: phase: \"landing\" is no phase"));
  EXPECT_THAT(told(unknown), HasSubstr("flight, compression, extension"));
  const auto elsewhere =
      read("t_s,phase,force_N\n0,wait,0\n0.001,push,3\n0.002,push,4\n", {.plant = "intruder"});
  EXPECT_TRUE(elsewhere.usable()) << told(elsewhere) << "no phase of a hop";
}

TEST(ForeignTable, DatesAndTimesOfDayBecomeSeconds) {
  const auto iso = read(
      "Timestamp,force_N\n2023-09-13T20:41:18.250Z,1\n2023-09-13T20:41:18.500Z,2\n2023-09-13T20:41:19.000Z,"
      "3\n",
      {.plant = "intruder", .campaign = "[columns]\nt_s = \"Timestamp\"\n"});
  ASSERT_TRUE(iso.usable()) << told(iso);
  EXPECT_NEAR(iso.t_s[2] - iso.t_s[0], 0.75, 1e-6);
  const auto german = read("Zeit;force_N\n13.09.2023 23:59:59,5;1\n14.09.2023 00:00:00,5;2\n",
                           {.plant = "intruder", .campaign = "[columns]\nt_s = \"Zeit\"\n"});
  ASSERT_EQ(german.rows(), 2U) << told(german);
  EXPECT_NEAR(german.t_s[1] - german.t_s[0], 1.0, 1e-6);
  const auto day = read("clock,force_N\n23:59:59.9,1\n00:00:00.1,2\n00:00:00.3,3\n",
                        {.plant = "intruder", .campaign = "[columns]\nt_s = \"clock\"\n"});
  ASSERT_EQ(day.rows(), 3U) << told(day);
  EXPECT_NEAR(day.t_s[2] - day.t_s[0], 0.4, 1e-6);
}

TEST(ForeignTable, BinaryFilesAreNamedWithTheWayOut) {
  for (const auto& [bytes, name] :
       {std::pair{std::string("PK\x03\x04") + std::string(40, '\0'), "xlsx"},
        std::pair{std::string("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1") + std::string(40, '\1'), ".xls"},
        std::pair{std::string("\x89HDF\r\n\x1A\n more"), "HDF5"},
        std::pair{std::string("PAR1xxxx"), "Parquet"}, std::pair{std::string("LOGG\x90"), "BLF"},
        std::pair{std::string("MDF     4.10"), "ASAM MDF"}}) {
    const auto recording = read(bytes);
    EXPECT_FALSE(recording.usable());
    ASSERT_EQ(recording.findings.size(), 1U) << told(recording);
    EXPECT_THAT(told(recording), HasSubstr(name));
    EXPECT_THAT(told(recording), ::testing::ContainsRegex("CSV|csv"));
  }
}

TEST(ForeignTable, ForceAgainstDepthNeedsNoTime) {
  for (const std::string header : {"force_N,foot_z_m", "Load [N],Depth [mm]", "Kraft (N);Weg (mm)"}) {
    const bool own = header.starts_with("force");
    const char separator = header.find(';') == std::string::npos ? ',' : ';';
    std::string text = header + "\n";
    for (int i = 0; i < 60; ++i)
      text += fmt::format("{:.3f}{}{:.5f}\n", 0.05 * i * i, separator, own ? -4e-4 * i : 0.4 * i);
    const std::string depth = header.substr(header.find(separator) + 1),
                      force = header.substr(0, header.find(separator));
    const auto recording =
        read(text,
             {.plant = "intruder",
              .campaign =
                  own ? ""
                      : fmt::format(
                            "[columns]\nforce_N = \"{}\"\nfoot_z_m = {{ column = \"{}\", scale = -0.001 }}\n",
                            force, depth)});
    ASSERT_TRUE(recording.usable()) << told(recording);
    EXPECT_FALSE(recording.has_time);
    EXPECT_NEAR(recording.channel("foot_z_m")[10], -4e-3, 1e-9);
    EXPECT_THAT(told(recording), HasSubstr("the file has no time"));
  }
}

TEST(ForeignTable, APathOfWindowsIsNamed) {
  for (const auto& [path, meant] :
       {std::pair{"data\\rec.csv", "data/rec.csv"}, std::pair{"data\\trial.csv", "data/trial.csv"},
        std::pair{"runs\\\\new.csv", "runs/new.csv"}}) {
    CampaignFolder folder;
    folder.write("campaign.toml", fmt::format("plant = \"rotary_axis\"\n[[trial]]\nfile = \"{}\"\n", path))
        .write(meant, swinging());
    const auto campaign = load_campaign(folder.path());
    const auto recording = read_trial(campaign, campaign.trials.at(0));
    EXPECT_THAT(told(recording), HasSubstr(fmt::format("write file = \"{}\", which exists", meant)));
    EXPECT_EQ(told(recording).find('\r'), std::string::npos);
    EXPECT_EQ(told(recording).find('\t'), std::string::npos);
  }
}

// A wheel that turns by 0.01 to 0.45 of a turn per sample, recorded modulo one turn.
TEST(ForeignTable, TurnsArePutBackAtAnySpeedBelowHalfATurnARow) {
  constexpr double kTurn = 6.283185307179586;
  for (const double per_row : {0.01, 0.08, 0.15, 0.3, 0.45})
    for (const double sign : {1.0, -1.0}) {
      std::vector<double> read, whole;
      for (int i = 0; i < 400; ++i) {
        whole.push_back(sign * kTurn * per_row * i);
        read.push_back(whole.back() - kTurn * std::floor(whole.back() / kTurn));
      }
      EXPECT_GT(put_turns_back(read), 0u) << per_row;
      for (std::size_t i = 0; i < read.size(); ++i)
        ASSERT_NEAR(read[i] - read[0], whole[i] - whole[0], 1e-6) << per_row << " at " << i;
    }
}

}  // namespace
}  // namespace sandhopper
