#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "campaign_folder.hpp"
#include "tools/campaign/plausible.hpp"
#include "tools/campaign/trial_recording.hpp"
#include "tools/campaign/written_unit.hpp"

// Units that a file states, values that are impossible for the plant, and times with too few digits.
namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using enum FindingKind;

struct Rig {
  std::string plant = "intruder";
  std::string columns{};
  std::string trial{};
};

TrialRecording read(const std::string& csv, const Rig& rig) {
  CampaignFolder folder;
  folder
      .write("campaign.toml", fmt::format("plant = \"{}\"\n[columns]\n{}\n[[trial]]\nfile = \"a.csv\"\n{}\n",
                                          rig.plant, rig.columns, rig.trial))
      .write("a.csv", csv);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

// A plate that sinks 0.33 mm per row, in the units of the file.
std::string press(const std::string& depth, const std::string& force, double depth_per_m,
                  double force_per_N) {
  std::string text = fmt::format("t,{},{}\n", force, depth);
  for (int i = 0; i < 70; ++i) {
    const double noise = 0.3 * std::sin(7.0 * i * i);
    text += fmt::format("{:.1f},{:.5g},{:.6g}\n", 0.1 * i, force_per_N * (0.9 * i + noise),
                        depth_per_m * (3.3e-4 * i + 1e-5 * noise));
  }
  return text;
}

TEST(Units, NamesAreRead) {
  const auto unit = [](std::string_view name) { return unit_in_name(name); };
  for (const auto& [name, dimension, to_si] :
       {std::tuple{"Sinkage (mm)", "length", 1e-3}, std::tuple{"force_kN", "force", 1e3},
        std::tuple{"Winkel [°]", "angle", 0.017453293}, std::tuple{"rpm", "angular rate", 0.104719755},
        std::tuple{"Kraft / N", "force", 1.0}, std::tuple{"Weg in mm", "length", 1e-3},
        std::tuple{"Speed, rpm", "angular rate", 0.104719755}, std::tuple{"Drehmoment [N·m]", "torque", 1.0},
        std::tuple{"torque_mNm", "torque", 1e-3}, std::tuple{"torque_kNm", "torque", 1e3},
        std::tuple{"angleDeg", "angle", 0.017453293}, std::tuple{"TIME_MS", "time", 1e-3},
        std::tuple{"omega_rad_s", "angular rate", 1.0}, std::tuple{"Speed_mm_per_s", "speed", 1e-3},
        std::tuple{"Acc_m_per_s2", "acceleration", 1.0}, std::tuple{"acc_mm_s2", "acceleration", 1e-3},
        std::tuple{"v_cm_s", "speed", 1e-2}, std::tuple{"Time (ms)", "time", 1e-3}}) {
    ASSERT_TRUE(unit(name)) << name;
    EXPECT_EQ(unit(name)->dimension, dimension) << name;
    EXPECT_NEAR(unit(name)->to_si / to_si, 1.0, 1e-6) << name;
  }
  for (const auto* name : {"foot", "height", "Load cell (left)", "Ch 1", "position"})
    EXPECT_FALSE(unit(name)) << name;
}

TEST(Units, ANameAgainstItsScaleIsAskedWithTheArithmetic) {
  struct Case {
    std::string depth, mapping;
    double per_m;
    std::string cure;
  };
  for (const auto& [depth, mapping, per_m, cure] :
       {Case{"Sinkage (mm)", "scale = -1.0", 1e3, "unit = \"mm\", scale = -0.001"},
        Case{"Tiefe [cm]", "scale = -0.001", 1e2, "unit = \"cm\", scale = -0.01"},
        Case{"depth_um", "scale = -1.0", 1e6, "unit = \"um\", scale = -1e-06"},
        Case{"Sinkage / in", "offset = 0.0", 39.37, "unit = \"in\", scale = 0.0254"}}) {
    const auto recording =
        read(press(depth, "F", per_m, 1.0),
             {.columns = fmt::format("t_s = \"t\"\nforce_N = \"F\"\nfoot_z_m = {{ column = \"{}\", {} }}",
                                     depth, mapping)});
    EXPECT_FALSE(recording.usable());
    const auto* finding = find(recording, unit_disagrees);
    ASSERT_NE(finding, nullptr) << depth;
    EXPECT_THAT(finding->cure, HasSubstr(cure));
    EXPECT_THAT(finding->what, HasSubstr(" m of them"));
  }
}

TEST(Units, ScaleAndUnitTogetherAreTheUsersWord) {
  const auto with = [](const std::string& mapping, double per_m) {
    return read(press("Sinkage (mm)", "F", per_m, 1.0),
                {.columns = "t_s = \"t\"\nforce_N = \"F\"\nfoot_z_m = { column = \"Sinkage (mm)\", " +
                            mapping + " }"});
  };
  const auto right = with("scale = -0.001", 1e3);
  EXPECT_TRUE(right.usable());
  EXPECT_NEAR(right.channel("foot_z_m").back(), -3.3e-4 * 69, 1e-5);
  EXPECT_NEAR(with("unit = \"mm\"", 1e3).channel("foot_z_m").back(), 3.3e-4 * 69, 1e-5);
  EXPECT_NEAR(with("unit = \"m\", scale = -1.0", 1.0).channel("foot_z_m").back(), -3.3e-4 * 69, 1e-5);
  EXPECT_EQ(find(with("unit = \"mm\", scale = -1.0", 1e3), unit_disagrees)->severity,
            FindingSeverity::trial_unusable);
}

// An axis whose columns have these names and, if given, these units.
TrialRecording turn(const std::string& names, const std::string& units, const std::string& columns) {
  std::string text = names + "\n" + (units.empty() ? "" : units + "\n");
  for (int i = 0; i < 40; ++i)
    text +=
        fmt::format("{:.3f},{:.4f},{:.4f}\n", 0.01 * i, 17.2 * std::cos(0.04 * i), 3.0 * std::sin(0.09 * i));
  return read(text, {.plant = "rotary_axis", .columns = columns});
}

TEST(Units, AUnitAloneDoesNotOutweighTheFilesOwn) {
  struct Case {
    std::string names, units, mapping;
    std::vector<std::string> what, cure;
  };
  const auto lines = [](const std::string& column, const std::string& unit) {
    return std::vector<std::string>{
        fmt::format("position_rad = {{ column = \"{}\", unit = \"{}\", scale = 0.0174532925 }}", column,
                    unit),
        fmt::format("position_rad = {{ column = \"{}\", unit = \"rad\", scale = 1 }}", column)};
  };
  for (const auto& [names, units, mapping, what, cure] :
       {Case{"t,Angle (deg),M",
             "",
             "position_rad = { column = \"Angle (deg)\", unit = \"rad\" }",
             {"its name says \"deg\"", "unit = \"rad\"",
              "17.2 deg are 0.3002 rad, and unit = \"rad\" makes 17.2 rad of them"},
             lines("Angle (deg)", "deg")},
        Case{"t,Winkel,M",
             "s,°,Nm",
             "position_rad = { column = \"Winkel\", unit = \"rad\" }",
             {"the row of units says \"°\"", "17.2 ° are 0.3002 rad", "17.2 rad of them"},
             lines("Winkel", "°")},
        Case{"t,a,Torque (mNm)",
             "",
             "position_rad = { column = \"Torque (mNm)\", unit = \"rad\" }",
             {"its name says \"mNm\", a torque", "unit = \"rad\""},
             {"unit = \"mNm\", scale = …", "unit = \"rad\", scale = 1 }"}}}) {
    const auto recording = turn(names, units, "t_s = { column = \"t\", unit = \"s\" }\n" + mapping);
    EXPECT_FALSE(recording.usable()) << names;
    const auto* finding = find(recording, unit_disagrees);
    ASSERT_NE(finding, nullptr) << names;
    for (const auto& text : what) EXPECT_THAT(finding->what, HasSubstr(text));
    for (const auto& text : cure) EXPECT_THAT(finding->cure, HasSubstr(text));
  }
  const auto swapped = read(press("Sinkage (mm)", "Force (kN)", 1e3, 1e-3),
                            {.columns = "t_s = \"t\"\nforce_N = { column = \"Sinkage (mm)\", unit = \"N\" }\n"
                                        "foot_z_m = { column = \"Force (kN)\", unit = \"m\" }"});
  EXPECT_EQ(std::ranges::count(swapped.findings, unit_disagrees, &Finding::kind), 2);
  const auto angle = turn("t,Angle (deg),M", "", "t_s = \"t\"\ntorque_Nm = \"Angle (deg)\"");
  EXPECT_THAT(find(angle, unit_disagrees)->what, HasSubstr("\"deg\", an angle"));
}

TEST(Units, AUnitThatAgreesOrComesWithItsScaleIsTaken) {
  for (const auto* mapping : {"unit = \"deg\"", "unit = \"°\""}) {
    const auto recording =
        turn("t,Angle (deg),M", "",
             fmt::format("t_s = \"t\"\nposition_rad = {{ column = \"Angle (deg)\", {} }}", mapping));
    EXPECT_EQ(find(recording, unit_disagrees), nullptr) << mapping;
  }
  const auto overruled =
      turn("t,Angle (deg),M", "",
           "t_s = \"t\"\nposition_rad = { column = \"Angle (deg)\", unit = \"rad\", scale = 1.0 }");
  ASSERT_NE(find(overruled, unit_disagrees), nullptr) << "taken, and the file's own unit is told";
  EXPECT_EQ(find(overruled, unit_disagrees)->severity, FindingSeverity::note);
  EXPECT_EQ(find(turn("t,Angle (deg),M", "s,rad,Nm",
                      "t_s = \"t\"\nposition_rad = { column = \"Angle (deg)\", unit = \"rad\" }"),
                 unit_disagrees),
            nullptr)
      << "the row of units goes before the name";
  EXPECT_EQ(
      find(turn("t,Sensor A,M", "", "t_s = \"t\"\nposition_rad = { column = \"Sensor A\", unit = \"rad\" }"),
           unit_disagrees),
      nullptr)
      << "A is the sensor's letter";
}

TEST(Units, ARowOfUnitsCountsForMappedAndForOwnNames) {
  std::string axis = "Time,Angle,Speed,Torque\ns,deg,rpm,Nm\n", own = "t_s,foot_z_m,force_N\ns,mm,N\n",
              kilo = "t_s;foot_z_m;force_N\n[s];[m];[kN]\n";
  for (int i = 0; i < 40; ++i) {
    const double t = 0.01 * i;
    axis += fmt::format("{:.3f},{:.4f},{:.4f},{:.4f}\n", t, 17.2 * std::cos(4 * t), -11.5 * std::sin(4 * t),
                        0.3 * t);
    own += fmt::format("{:.3f},{:.3f},{:.3f}\n", t, -0.3 * i, 0.9 * i + 0.1 * std::sin(3.0 * i));
    kilo += fmt::format("{:.3f};{:.5f};{:.6f}\n", t, -3e-4 * i, 9e-4 * i);
  }
  const auto rotary = read(
      axis,
      {.plant = "rotary_axis",
       .columns =
           "t_s = \"Time\"\nposition_rad = \"Angle\"\nvelocity_radps = \"Speed\"\ntorque_Nm = \"Torque\""});
  EXPECT_EQ(std::count_if(rotary.findings.begin(), rotary.findings.end(),
                          [](const auto& f) { return f.kind == unit_disagrees; }),
            2);
  EXPECT_THAT(find(rotary, unit_disagrees)->cure, HasSubstr("scale = 0.0174532925"));
  const auto plate = read(own, {});
  EXPECT_FALSE(plate.usable());
  EXPECT_THAT(find(plate, unit_disagrees)->cure,
              HasSubstr("foot_z_m = { column = \"foot_z_m\", unit = \"mm\", scale = 0.001 }"));
  EXPECT_THAT(find(read(kilo, {}), unit_disagrees)->cure, HasSubstr("unit = \"kN\", scale = 1000"));
}

TEST(Units, VoltsNeedTheirScale) {
  const std::string csv = press("z", "Force (V)", -1.0, 0.01);
  const std::string rest = "t_s = \"t\"\nfoot_z_m = \"z\"\n";
  EXPECT_THAT(find(read(csv, {.columns = rest + "force_N = \"Force (V)\""}), unit_disagrees)->cure,
              HasSubstr("scale = …"));
  EXPECT_TRUE(read(csv, {.columns = rest + "force_N = { column = \"Force (V)\", scale = 100.0 }"}).usable());
  EXPECT_TRUE(
      read(csv, {.columns = rest + "force_N = { column = \"Force (V)\", unit = \"V\", scale = 100.0 }"})
          .usable());
}

TEST(Units, AListOfUnitsHasNoTwoThatOneToleranceConfuses) {
  EXPECT_TRUE(is_ratio_of_units(1000.0, "length"));
  EXPECT_TRUE(is_ratio_of_units(57.2958, "angle"));
  EXPECT_FALSE(is_ratio_of_units(2.0, "force")) << "a lever is no unit";
}

TEST(Plausible, MillimetresWithoutAName) {
  const std::string columns = "t_s = \"t\"\nforce_N = \"F\"\nfoot_z_m = { column = \"z\", scale = -1.0 }";
  const auto recording = read(press("z", "F", 1e3, 1.0), {.columns = columns});
  EXPECT_FALSE(recording.usable());
  EXPECT_EQ(find(recording, implausible)->channel, "foot_z_m");
  EXPECT_TRUE(read(press("z", "F", 1.0, 1.0), {.columns = columns}).usable());
  const auto stated = read(
      press("z", "F", 1e3, 1.0),
      {.columns = "t_s = \"t\"\nforce_N = \"F\"\nfoot_z_m = { column = \"z\", unit = \"m\", scale = -1.0 }"});
  EXPECT_TRUE(stated.usable()) << "its owner has said so";
  EXPECT_EQ(find(stated, implausible)->severity, FindingSeverity::note);
}

TEST(Plausible, KilonewtonsWithoutAName) {
  const std::string columns = "t_s = \"t\"\nforce_N = \"F\"\nfoot_z_m = { column = \"z\", scale = -1.0 }";
  const Rig rig{.columns = columns, .trial = "plate_diameter_m = 0.2"};
  EXPECT_EQ(find(read(press("z", "F", 1.0, 1e-3), rig), implausible)->channel, "force_N");
  EXPECT_EQ(find(read(press("z", "F", 1.0, 1.0), rig), implausible), nullptr);
}

std::string swing(double position_scale, double speed_scale, double time_scale = 1.0, double start = 0.0) {
  std::string text = "t_s,position_rad,velocity_radps,torque_Nm\n";
  for (int i = 0; i < 300; ++i) {
    const double t = 0.01 * i;
    text += fmt::format("{:.9f},{:.6f},{:.6f},{:.4f}\n", start + time_scale * t,
                        position_scale * 0.3 * std::cos(4 * t), -speed_scale * 1.2 * std::sin(4 * t),
                        0.1 * std::sin(9 * t));
  }
  return text;
}

TEST(Plausible, ASpeedThatIsNotTheRateOfItsPosition) {
  const Rig axis{.plant = "rotary_axis"};
  EXPECT_TRUE(read(swing(1.0, 1.0), axis).findings.empty());
  EXPECT_EQ(find(read(swing(1.0, 1.2), axis), implausible), nullptr) << "a gain that a diagnosis finds";
  for (const auto& [position, speed, hint] :
       {std::tuple{1.0, 57.2958, "deg/s"}, std::tuple{57.2958, 1.0, "position in degrees"},
        std::tuple{1.0, 9.5493, "rpm"}, std::tuple{57.2958, 9.5493, "degrees and the speed in rpm"},
        std::tuple{1.0, -1.0, "other sign"}}) {
    const auto recording = read(swing(position, speed), axis);
    ASSERT_NE(find(recording, implausible), nullptr) << hint;
    EXPECT_THAT(find(recording, implausible)->what, HasSubstr(hint));
    EXPECT_FALSE(recording.usable());
  }
  EXPECT_FALSE(read(swing(1.0, 1.0, 1000.0), axis).usable()) << "milliseconds";
  EXPECT_THAT(find(read(swing(1.0, 1.0, 1000.0, 1.7e12), axis), implausible)->what,
              HasSubstr("an epoch in ms"));
}

TEST(Plausible, HeightsAndDropsInOtherUnits) {
  const auto drop = [](double per_m) {
    std::string text = "t_s,height_m\n";
    for (int i = 0; i < 45; ++i)
      text += fmt::format("{:.3f},{:.5f}\n", 0.01 * i, per_m * (1.0 - 4.905e-4 * i * i));
    return text;
  };
  EXPECT_TRUE(read(drop(1.0), {.plant = "falling_body"}).usable());
  EXPECT_FALSE(read(drop(1000.0), {.plant = "falling_body"}).usable());
  EXPECT_FALSE(read(drop(100.0), {.plant = "falling_body"}).usable());
}

std::vector<Finding> believed(const std::string& plant, const std::string& nominal) {
  CampaignFolder folder;
  folder.write("nominal.toml", nominal)
      .write("campaign.toml",
             "plant = \"" + plant + "\"\nmodel = \"nominal.toml\"\n[[trial]]\nfile = \"a.csv\"\n");
  return load_campaign(folder.path()).findings;
}

TEST(Plausible, BeliefsThatNoLaboratoryHas) {
  EXPECT_EQ(believed("falling_body", "gravity_mps2 = 1.0\n").at(0).kind, implausible);
  EXPECT_TRUE(believed("falling_body", "gravity_mps2 = 9.80665\n").empty());
  EXPECT_TRUE(believed("falling_body", "gravity_mps2 = 1.62\n").empty()) << "the Moon";
  EXPECT_EQ(believed("falling_body", "[body]\nmass_kg = 4000\n").at(0).kind, implausible);
  EXPECT_EQ(believed("falling_body", "[body]\nmass_kg = 58\nfrontal_area_m2 = 0.00126\nvolume_m3 = 3.35e-5\n")
                .at(0)
                .channel,
            "body.mass_kg");
  EXPECT_TRUE(
      believed("falling_body", "[body]\nmass_kg = 9\nfrontal_area_m2 = 0.006\nvolume_m3 = 2.5e-3\n").empty());
  EXPECT_THROW(believed("rotary_axis", "gravity_mps2 = 981\n"), ConfigError);
  for (const auto& bound : plausible_bounds()) EXPECT_FALSE(bound.source.empty()) << bound.channel;
}

std::string clocked(const std::string& format, double step_s, double start_s, bool torque = true) {
  std::string text = "t_s,position_rad,torque_Nm\n";
  for (int i = 0; i < 60; ++i)
    text += fmt::format(fmt::runtime(format), start_s + step_s * i) +
            fmt::format(",{:.5f},{:.4f}\n", 0.3 * std::cos(0.05 * i), torque ? 0.1 * std::sin(0.3 * i) : 0.0);
  return text;
}

TEST(SampleTimes, TooFewDigitsAreSaidAsSuch) {
  const Rig axis{.plant = "rotary_axis"};
  for (const auto& [format, step, start, time] :
       {std::tuple{"{:.6g}", 0.01, 1.73234e9, "1.73234e+09"}, std::tuple{"{:.0f}", 5e-4, 5.0, "5"},
        std::tuple{"{:.3e}", 0.002, 73120.0, "73120"}}) {
    const auto all = read(clocked(format, step, start), axis);
    EXPECT_FALSE(all.usable());
    ASSERT_NE(find(all, coarse_time), nullptr) << time;
    EXPECT_THAT(find(all, coarse_time)->what,
                HasSubstr(fmt::format("all 60 rows have the same time ({})", time)));
  }
  for (const auto& [format, step, said] :
       {std::tuple{"{:.2f}", 0.001, "resolution of 10 ms, rows come every 1"},
        std::tuple{"{:.0f}", 0.1, "resolution of 1 s, rows come every"},
        std::tuple{"{:.3f}", 0.0004, "resolution of 1 ms"}}) {
    const auto recording = read(clocked(format, step, 5.0), axis);
    EXPECT_FALSE(recording.usable()) << said;
    ASSERT_NE(find(recording, coarse_time), nullptr) << said;
    EXPECT_THAT(find(recording, coarse_time)->what, HasSubstr(said));
    EXPECT_EQ(find(recording, time_stands_still), nullptr) << "one finding says it";
  }
}

TEST(SampleTimes, RowsAreSpreadWhereItsOwnerSaysSo) {
  const auto recording = read(clocked("{:.2f}", 0.001, 5.0),
                              {.plant = "rotary_axis", .trial = "format = { spread_times = true }"});
  ASSERT_TRUE(recording.usable());
  ASSERT_EQ(recording.rows(), 60U);
  EXPECT_NEAR(recording.t_s[40] - recording.t_s[20], 0.020, 0.002);
}

TEST(SampleTimes, CoarseStepsWithoutSharedTimesAreNoted) {
  const auto recording = read(clocked("{:.2f}", 0.0143, 5.0), {.plant = "rotary_axis"});
  EXPECT_TRUE(recording.usable());
  ASSERT_NE(find(recording, coarse_time), nullptr);
  EXPECT_EQ(find(recording, coarse_time)->severity, FindingSeverity::note);
  EXPECT_EQ(find(read(clocked("{:.3f}", 1.0 / 60.0, 5.0), {.plant = "rotary_axis"}), coarse_time), nullptr);
}

// A row every 2 ms; the last of each `of` rows is missing.
std::string with_lost_rows(int of) {
  std::string text = "t_s,position_rad,torque_Nm\n";
  for (int i = 0; i < 400; ++i)
    if (i % of != of - 1)
      text +=
          fmt::format("{:.3f},{:.5f},{:.4f}\n", 0.002 * i, 0.3 * std::cos(0.05 * i), 0.1 * std::sin(0.3 * i));
  return text;
}

TEST(SampleTimes, LostRowsAreNoCoarseTimes) {
  const Rig axis{.plant = "rotary_axis"};
  // With one of six rows lost, four of five time steps have the shortest length. If fewer have it, coarse
  // times are reported.
  for (const int of : {6, 9, 17}) EXPECT_EQ(find(read(with_lost_rows(of), axis), coarse_time), nullptr) << of;
  for (const double step_s : {0.0125, 0.0143, 0.0236})
    EXPECT_NE(find(read(clocked("{:.2f}", step_s, 5.0), axis), coarse_time), nullptr) << step_s;
}

TEST(HeldSamples, HeldAndFilledValuesAreFound) {
  for (const int hold : {2, 4, 10}) {
    std::string text = "t_s,foot_z_m,force_N\n";
    for (int i = 0; i < 400; ++i)
      text += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.002 * i,
                          0.005 - 1e-5 * (i / hold * hold) * (1 + 1e-3 * (i / hold)),
                          0.01 * i + 0.001 * std::sin(i));
    const auto recording = read(text, {});
    ASSERT_NE(find(recording, held_samples), nullptr) << hold;
    EXPECT_THAT(find(recording, held_samples)->what, HasSubstr(fmt::format("held over {} rows", hold)));
    // The repeats are no samples, the first row of each run is one.
    for (int i = 0; i < 400; ++i)
      ASSERT_EQ(std::isnan(recording.channel("foot_z_m")[static_cast<std::size_t>(i)]), i % hold != 0) << i;
  }
  std::string filled = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 200; ++i)
    filled += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.002 * i, -1e-4 * i, i % 4 == 0 ? 1.0 + 0.1 * i : 0.0);
  const auto recording = read(filled, {});
  ASSERT_NE(find(recording, held_samples), nullptr);
  EXPECT_TRUE(std::isnan(recording.channel("force_N")[1]));
  EXPECT_EQ(recording.channel("force_N")[4], 1.4);
}

}  // namespace
}  // namespace sandhopper
