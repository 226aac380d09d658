#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "campaign_folder.hpp"
#include "estimation/leg.hpp"
#include "tools/campaign/trial_recording.hpp"

// The checks that compare channels of one recording find wrong columns, units and signs. Every cure must work
// when its line is written into campaign.toml as it stands.
namespace sandhopper {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using enum FindingKind;

struct Rig {
  std::string plant;
  std::string csv;
  std::vector<std::string> columns{};  // lines of [columns]
  std::string trial{};
  std::string nominal{};
};

TrialRecording read(const Rig& rig) {
  CampaignFolder folder;
  folder.write("nominal.toml", rig.nominal)
      .write("campaign.toml",
             fmt::format(
                 "plant = \"{}\"\nmodel = \"nominal.toml\"\n[columns]\n{}\n[[trial]]\nfile = \"a.csv\"\n{}\n",
                 rig.plant, fmt::join(rig.columns, "\n"), rig.trial))
      .write("a.csv", rig.csv);
  const auto campaign = load_campaign(folder.path());
  return read_trial(campaign, campaign.trials.at(0));
}

// The lines "channel = { … }" of a cure, each in place of the one for its channel. `which`: 0, the first
// offer; of several offers ("or") only that one is written.
Rig cured(Rig rig, const std::string& cure, std::size_t which = 0) {
  std::vector<std::string> offers;
  for (std::size_t begin = 0; begin < cure.size();) {
    const auto end = std::min(cure.find(", or ", begin), cure.size());
    offers.push_back(cure.substr(begin, end - begin));
    begin = end + 5;
  }
  const std::string& offer = offers.at(which);
  for (std::size_t at = offer.find(" = { column"); at != std::string::npos;
       at = offer.find(" = { column", at + 1)) {
    const auto begin = offer.rfind(' ', at - 1) + 1;
    const std::string channel = offer.substr(begin, at - begin);
    const std::string line = offer.substr(begin, offer.find('}', at) + 1 - begin);
    std::erase_if(rig.columns, [&](const std::string& old) { return old.starts_with(channel + " "); });
    rig.columns.push_back(line);
  }
  return rig;
}

Finding finding(const TrialRecording& recording, FindingKind kind) {
  const auto* found = find(recording, kind);
  EXPECT_NE(found, nullptr) << "no finding of this kind";
  return found == nullptr ? Finding{} : *found;
}

void expect_fine(const Rig& rig) {
  const auto recording = read(rig);
  EXPECT_TRUE(recording.usable());
  for (const auto& found : recording.findings)
    EXPECT_TRUE(found.kind != implausible && found.kind != unit_disagrees) << to_string(found);
}

// A rod pushed at 10 mm/s, its depth in inches, its force in lbf.
std::string probe() {
  std::string text = "Elapsed (s),Depth (in),Load (lbf)\n";
  for (int i = 0; i < 300; ++i) {
    const double t = 0.04 * i, depth = 0.01 * t, noise = std::sin(7.0 * i * i);
    text += fmt::format("{:.2f},{:.4f},{:.3f}\n", t, (depth + 1e-5 * noise) / 0.0254,
                        (900.0 * depth + 0.1 * noise) / 4.448);
  }
  return text;
}

const std::string kTime = "t_s = \"Elapsed (s)\"";

TEST(Cures, ADepthCountedUpwardKeepsTheUnitOfItsColumn) {
  const Rig rig{"intruder",
                probe(),
                {kTime, "foot_z_m = { column = \"Depth (in)\", scale = 0.0254, offset = 0.01 }",
                 "force_N = { column = \"Load (lbf)\", unit = \"lbf\" }"}};
  const auto wrong = finding(read(rig), implausible);
  EXPECT_THAT(wrong.cure, HasSubstr("foot_z_m = { column = \"Depth (in)\", unit = \"in\", scale = -0.0254, "
                                    "offset = -0.01 }"));
  expect_fine(cured(rig, wrong.cure));
}

TEST(Cures, DepthAndLoadExchangedAreToldApartByTheirUnits) {
  for (const std::string how : {"scale = -0.0254", "unit = \"m\", scale = -0.0254", "unit = \"in\""}) {
    Rig rig{"intruder",
            probe(),
            {kTime, "foot_z_m = { column = \"Load (lbf)\", " + how + " }",
             "force_N = { column = \"Depth (in)\", unit = \"lbf\" }"}};
    const auto recording = read(rig);
    ASSERT_FALSE(recording.usable()) << how;
    for (const auto& found : recording.findings)
      if (found.kind == unit_disagrees) {
        EXPECT_THAT(found.what, HasSubstr("exchanged"));
        expect_fine(cured(rig, found.cure));
      }
  }
}

std::string swing(double position_scale, double speed_scale, bool exchange = false, double time_scale = 1.0) {
  std::string text = "t,a,b,c\n";
  for (int i = 0; i < 400; ++i) {
    const double t = 0.01 * i, x = position_scale * 0.3 * std::cos(4 * t), torque = 0.1 * std::sin(9 * t);
    text += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f}\n", time_scale * t, exchange ? torque : x,
                        -speed_scale * 1.2 * std::sin(4 * t), exchange ? x : torque);
  }
  return text;
}

Rig axis(std::string csv, const std::string& position, const std::string& speed) {
  return {"rotary_axis",
          std::move(csv),
          {"t_s = { column = \"t\", unit = \"s\" }", "position_rad = { column = \"a\", " + position + " }",
           "velocity_radps = { column = \"b\", " + speed + " }",
           "torque_Nm = { column = \"c\", unit = \"N m\" }"}};
}

TEST(Cures, APositionsUnitIsNotBlamedOnTheSpeedAlone) {
  const auto rig = axis(swing(1.0, 1.0), "unit = \"deg\"", "unit = \"rad/s\"");
  const auto wrong = finding(read(rig), implausible);
  EXPECT_THAT(wrong.cure, HasSubstr("position_rad = { column = \"a\", unit = \"rad\", scale = 1 }"));
  expect_fine(cured(rig, wrong.cure, 0));
  expect_fine(cured(rig, wrong.cure, 1));
}

TEST(Cures, AUnitThatTheFileStatesIsNotDoubted) {
  auto rig = axis(swing(57.2958, 57.2958), "unit = \"deg\"", "unit = \"rad/s\"");
  rig.csv.replace(0, 8, "t,a (deg),b,c\n");
  rig.columns[1] = "position_rad = { column = \"a (deg)\", unit = \"deg\" }";
  const auto wrong = finding(read(rig), implausible);
  EXPECT_THAT(wrong.cure, AllOf(HasSubstr("velocity_radps"), Not(HasSubstr("position_rad"))));
  expect_fine(cured(rig, wrong.cure));
}

TEST(Cures, RatiosOfUnitsBelowFiveInCleanData) {
  for (const double ratio : {2.54, 1 / 2.54, 3.6, 1 / 0.3048, 3.0}) {  // 3: the other side of a gear
    const auto rig = axis(swing(1.0, ratio), "unit = \"rad\"", "unit = \"rad/s\"");
    EXPECT_FALSE(read(rig).usable()) << ratio;
  }
  for (const double gain : {0.7, 1.0, 1.2, 1.9, 2.8})
    expect_fine(axis(swing(1.0, gain), "unit = \"rad\"", "unit = \"rad/s\""));
}

TEST(Cures, PositionAndTorqueExchanged) {
  const auto rig = axis(swing(1.0, 1.0, true), "unit = \"rad\"", "unit = \"rad/s\"");
  const auto wrong = finding(read(rig), implausible);
  EXPECT_EQ(wrong.channel, "position_rad");
  EXPECT_THAT(wrong.what, HasSubstr("torque_Nm"));
  expect_fine(cured(rig, wrong.cure));
}

// A foot that rings in flight around 1 m/s2 and lands with 120: not in g, because it never rests there.
TEST(Cures, AFlightBetweenLandingsIsNoRest) {
  std::string text = "t_s,imu_foot_accel_z_mps2\n";
  for (int i = 0; i < 500; ++i)
    text += fmt::format("{:.3f},{:.4f}\n", 0.002 * i, i % 250 < 10 ? 120.0 : 1.0 + 3.0 * std::sin(0.9 * i));
  expect_fine({"hopper", text});
}

// One encoder drifts, its twin moves like the speed of both: the twin's column stands where it belongs.
TEST(Cures, ATwinThatMovesAlikeIsNotExchanged) {
  std::string text =
      "t_s,motor_left_position_rad,motor_left_velocity_radps,motor_right_position_rad,"
      "motor_right_velocity_radps\n";
  for (int i = 0; i < 400; ++i) {
    const double t = 0.002 * i, x = 0.9 + 0.2 * std::sin(20.0 * t), v = 4.0 * std::cos(20.0 * t);
    text += fmt::format("{:.3f},{:.5f},{:.5f},{:.5f},{:.5f}\n", t, x + 0.15 * std::sin(27.0 * t), v, x, v);
  }
  expect_fine({"hopper", text});
}

// Heights of a body: z(t), in units of which `per_m` make one metre.
Rig drop(const std::function<double(double)>& height_m, double per_m, const std::string& how,
         const std::string& nominal = "", double last_s = 0.4) {
  std::string text = "t,h,Load (N)\n";
  for (int i = 0; i < 80; ++i) {
    const double t = last_s * i / 79.0;
    text += fmt::format("{:.5f},{:.6g},1\n", t, per_m * height_m(t));
  }
  return {"falling_body",
          text,
          {"t_s = { column = \"t\", unit = \"s\" }", "height_m = { column = \"h\", " + how + " }"},
          "kind = \"drop\"",
          nominal};
}

double fall(double t) { return 0.9 - 0.5 * 9.81 * t * t; }

TEST(Cures, AHeightInAnotherUnitFallsWithAnotherGravity) {
  expect_fine(drop(fall, 1.0, "unit = \"m\""));
  for (const auto& [per_m, stated, truth] :
       {std::tuple{100.0, "mm", "cm"}, std::tuple{1000.0, "cm", "mm"}, std::tuple{1 / 0.0254, "cm", "in"},
        std::tuple{100.0, "in", "cm"}, std::tuple{1 / 0.3048, "m", "ft"}}) {
    const auto rig = drop(fall, per_m, fmt::format("unit = \"{}\"", stated));
    const auto wrong = finding(read(rig), implausible);
    EXPECT_THAT(wrong.cure, HasSubstr(fmt::format("unit = \"{}\"", truth)));
    expect_fine(cured(rig, wrong.cure));
  }
}

TEST(Cures, DragAndALiquidAreNoUnits) {
  // Terminal speed 1.2 m/s in air; a ball in oil at a steady 0.05 m/s.
  const auto braked = [](double t) { return 0.9 - 1.2 * 1.2 / 9.81 * std::log(std::cosh(9.81 * t / 1.2)); };
  for (const double last_s : {0.2, 0.3, 0.4, 0.6}) expect_fine(drop(braked, 1.0, "unit = \"m\"", "", last_s));
  const auto sinks = [](double t) { return 0.9 - 0.05 * t; };
  expect_fine(drop(sinks, 1.0, "unit = \"m\"", "[medium]\ndensity_kg_per_m3 = 900.0\n", 10.0));
}

TEST(Cures, AConeThatIsPushedIsNoFallingBody) {
  for (const double sign : {1.0, -1.0}) {
    const auto rig = drop([&](double t) { return sign * (0.01 * t - 0.3); }, 1.0, "unit = \"m\"", "", 13.0);
    const auto wrong = finding(read(rig), implausible);
    EXPECT_THAT(wrong.what, HasSubstr("takes 12 s for 0.13 m"));
    EXPECT_THAT(wrong.cure, AllOf(HasSubstr("--plant intruder"), HasSubstr("\"Load (N)\" is a force"),
                                  Not(HasSubstr("scale = -1"))));
  }
}

// A plate pressed at 10 mm/s; its depth in units of which `per_m` make one metre.
Rig press(double per_m, const std::string& how, const std::string& speed) {
  std::string text = "t,z,F\n";
  for (int i = 0; i < 300; ++i) {
    const double t = 0.02 * i, depth = 0.01 * t, noise = std::sin(7.0 * i * i);
    text +=
        fmt::format("{:.2f},{:.6g},{:.3f}\n", t, per_m * (depth + 2e-5 * noise), 900.0 * depth + 0.1 * noise);
  }
  return {"intruder",
          text,
          {"t_s = { column = \"t\", unit = \"s\" }", "foot_z_m = { column = \"z\", " + how + " }",
           "force_N = { column = \"F\", unit = \"N\" }"},
          "impact_speed_mps = " + speed};
}

TEST(Cures, ADepthGoesDownWithTheSpeedThatTheSetUpStates) {
  expect_fine(press(1e3, "scale = -0.001", "0.01"));
  expect_fine(press(1e3, "scale = -0.001", "0.013"));
  const auto inches = press(1.0 / 0.0254, "scale = -0.01", "0.01");
  const auto wrong = finding(read(inches), implausible);
  EXPECT_THAT(wrong.what, HasSubstr("0.394 times"));
  EXPECT_THAT(wrong.cure, HasSubstr("foot_z_m = { column = \"z\", unit = \"in\", scale = -0.0254 }"));
  expect_fine(cured(inches, wrong.cure));
}

TEST(Cures, DepthAndForceExchangedWithoutUnitsInTheFileGoDownTooFast) {
  auto rig = press(1e3, "scale = -0.001", "0.01");
  rig.columns[1] = "foot_z_m = { column = \"F\", scale = -0.001 }";
  rig.columns[2] = "force_N = { column = \"z\", scale = 1.0 }";
  rig.trial = "impact_speed_mps = 0.05";
  EXPECT_THAT(finding(read(rig), implausible).cure, HasSubstr("exchanged"));
}

// A driven pendulum of 0.012 kg m2, its torque in units of which `per_Nm` make one N m.
Rig pendulum(double per_Nm, const std::string& how, const std::string& nominal) {
  std::string text = "t,x,M\n";
  double x = 0.0, v = 0.0;
  for (int i = 0; i < 1200; ++i) {
    const double t = 0.002 * i, torque = 1.5 * std::sin(6.0 * t) + 0.8 * std::sin(17.0 * t + 1.0);
    text += fmt::format("{:.3f},{:.6f},{:.5g}\n", t, x, per_Nm * torque);
    for (int k = 0; k < 10; ++k) {
      const double a = (torque - 1.1 * std::sin(x) - 0.05 * std::tanh(v / 0.02) - 0.02 * v) / 0.012;
      v += 2e-4 * a, x += 2e-4 * v;
    }
  }
  return {"rotary_axis",
          text,
          {"t_s = { column = \"t\", unit = \"s\" }", "position_rad = { column = \"x\", unit = \"rad\" }",
           "torque_Nm = { column = \"M\", " + how + " }"},
          "",
          nominal};
}

TEST(Cures, ATorqueAcceleratesTheInertiaThatIsBelieved) {
  const std::string inertia = "[axis]\ninertia_kg_m2 = 0.012\n";
  expect_fine(pendulum(1.0, "unit = \"N m\"", inertia));
  expect_fine(pendulum(1.0, "unit = \"N m\"", "[axis]\ninertia_kg_m2 = 0.03\n"));
  for (const auto& [per_Nm, how] :
       {std::pair{1e3, "unit = \"N m\""}, std::pair{-1.0, "unit = \"N m\""},
        std::pair{1.0 / 9.80665, "unit = \"N m\""}, std::pair{1e3, "scale = -0.001"}}) {
    const auto rig = pendulum(per_Nm, how, inertia);
    const auto recording = read(rig);
    EXPECT_FALSE(recording.usable()) << per_Nm;
    expect_fine(cured(rig, finding(recording, implausible).cure));
  }
  EXPECT_TRUE(read(pendulum(1.0, "unit = \"N m\"", "[axis]\ninertia_kg_m2 = 0.002\n")).usable())
      << "a ratio of no unit is a note";
}

// A stance of the default leg: it shortens and lengthens, the foot at rest, the currents carry the robot.
Rig stance(const std::vector<std::string>& columns) {
  const Leg leg{LegParameters{}};
  std::string text = "t,a,i,body,foot,phase\n";
  for (int k = 0; k < 200; ++k) {
    const double t = 0.002 * k, angle = 0.9 + 0.2 * std::sin(std::numbers::pi * k / 200.0);
    text += fmt::format("{:.3f},{:.6f},{:.4f},{:.6f},{:.6f},1\n", t, angle, -6.0 + std::sin(9.0 * k),
                        leg.kinematics(angle).length_m + 0.12, 0.0);
  }
  Rig rig{"hopper", text, {"t_s = { column = \"t\", unit = \"s\" }", "phase = { column = \"phase\" }"}, ""};
  rig.columns.insert(rig.columns.end(), columns.begin(), columns.end());
  return rig;
}

const std::string kAngle = "motor_left_position_rad = { column = \"a\", unit = \"rad\" }";
const std::string kCurrent = "motor_left_current_A = { column = \"i\", unit = \"A\" }";
const std::string kBody = "mocap_body_z_m = { column = \"body\", unit = \"m\" }";
const std::string kFoot = "mocap_foot_z_m = { column = \"foot\", unit = \"m\" }";

TEST(Cures, AHopThatIsMappedRightIsNotDoubted) {
  expect_fine(stance({kAngle, kCurrent, kBody, kFoot}));
  expect_fine(stance({kAngle, kCurrent, kBody}));
  expect_fine(stance({kAngle, kCurrent}));
}

TEST(Cures, HipAndSoleExchanged) {
  const auto rig = stance({kAngle, kCurrent, "mocap_body_z_m = { column = \"foot\", unit = \"m\" }",
                           "mocap_foot_z_m = { column = \"body\", unit = \"m\" }"});
  const auto wrong = finding(read(rig), implausible);
  EXPECT_THAT(wrong.what, HasSubstr("exchanged"));
  expect_fine(cured(rig, wrong.cure));
}

TEST(Cures, AnAngleFromTheHorizontalOrInDegreesGoesAgainstTheLeg) {
  for (const std::string how : {"scale = -1.0", "unit = \"deg\""}) {
    const auto doubtful =
        stance({kCurrent, kBody, "motor_left_position_rad = { column = \"a\", " + how + " }"});
    const auto recording = read(doubtful);
    EXPECT_FALSE(recording.usable()) << how;
    EXPECT_EQ(finding(recording, implausible).channel, "motor_left_position_rad") << how;
    expect_fine(cured(doubtful, finding(recording, implausible).cure));
  }
  // The file holds pi/2 - angle.
  auto rig = stance({kCurrent, kBody, kAngle});
  std::string turned = "t,a,i,body,foot,phase\n";
  const Leg leg{LegParameters{}};
  for (int k = 0; k < 200; ++k) {
    const double angle = 0.9 + 0.2 * std::sin(std::numbers::pi * k / 200.0);
    turned += fmt::format("{:.3f},{:.6f},{:.4f},{:.6f},0,1\n", 0.002 * k, 0.5 * std::numbers::pi - angle,
                          -6.0 + std::sin(9.0 * k), leg.kinematics(angle).length_m + 0.12);
  }
  rig.csv = turned;
  const auto wrong = finding(read(rig), implausible);
  EXPECT_THAT(wrong.what, HasSubstr("from the horizontal"));
  expect_fine(cured(rig, wrong.cure));
}

TEST(Cures, CurrentsThatShortenTheLegInStanceHaveTheOtherSign) {
  auto rig = stance({kAngle, kBody, "motor_left_current_A = { column = \"i\", scale = -1.0 }"});
  const auto wrong = finding(read(rig), implausible);
  EXPECT_EQ(wrong.channel, "motor_left_current_A");
  expect_fine(cured(rig, wrong.cure));
}

TEST(Findings, OfSeveralFilesWithTheSameWordsAreOneLine) {
  const auto one = [](const std::string& file, std::uint64_t line, const std::string& what) {
    return Finding{gap, FindingSeverity::note, file, line, 1, "t_s", what, ""};
  };
  const auto lines = in_lines({one("a.csv", 3, "a gap of 0.5 s"), one("a.csv", 9, "a gap of 0.7 s"),
                               one("b.csv", 4, "a gap of 0.6 s"), one("b.csv", 4, "a gap of 0.6 s"),
                               one("c.csv", 5, "a gap of 1.5 s"), one("c.csv", 5, "another")},
                              true);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0], "a.csv:3:1: t_s: a gap of 0.5 s (note; likewise in 2 more files)");
  EXPECT_EQ(lines[1], "a.csv:9:1: t_s: a gap of 0.7 s (note)");
  EXPECT_EQ(lines[2], "c.csv:5:1: t_s: another (note)");
}

}  // namespace
}  // namespace sandhopper
