#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "read_campaign.hpp"

namespace sandhopper {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Reads one trial with its own model and keys.
Told read_with(const std::string& head, const std::string& nominal, const std::string& trial,
               const std::string& csv) {
  CampaignFolder folder;
  folder.write("nominal.toml", nominal).write("a.csv", csv);
  folder.write("campaign.toml",
               "model = \"nominal.toml\"\n" + head + "[[trial]]\nfile = \"a.csv\"\n" + trial);
  const auto campaign = load_campaign(folder.path());
  Told told{read_trial(campaign, campaign.trials.at(0)), ""};
  for (const auto& finding : told.recording.findings) told.text += to_string(finding) + "\n";
  return told;
}

// A pendulum that swings free from 20 degrees; its angle in any unit.
std::string swing(double per_rad, double drift_rad = 0.0) {
  std::string csv = "t,Winkel\n";
  for (int i = 0; i < 600; ++i) {
    const double t = 0.01 * i;
    csv += fmt::format("{:.3f},{:.5f}\n", t,
                       per_rad * (0.349 * std::exp(-0.05 * t) * std::cos(4.5 * t) + drift_rad * t));
  }
  return csv;
}

Told read_swing(const std::string& mapping, const std::string& trial, const std::string& csv,
                const std::string& gravity = "gravity_torque_Nm = 2.26\n") {
  const auto head = fmt::format(
      "plant = \"rotary_axis\"\n[columns]\nt_s = {{ column = \"t\", unit = \"s\" }}\n"
      "position_rad = {{ column = \"Winkel\"{} }}\n",
      mapping);
  return read_with(head, "[axis]\ninertia_kg_m2 = 0.112\n" + gravity, "kind = \"motion\"\n" + trial, csv);
}

TEST(FreeSwing, DegreesTakenForRadAreRefusedAndTheCureIsRead) {
  const auto refused = read_swing("", "motor_enabled = false\n", swing(57.29578));
  EXPECT_FALSE(refused.recording.usable());
  EXPECT_THAT(refused.text, HasSubstr("more than one turn"));
  EXPECT_THAT(refused.text, HasSubstr("unit = \"deg\", scale = 0.0174532925"));
  const auto cured = read_swing(", unit = \"deg\", scale = 0.0174532925", "", swing(57.29578));
  EXPECT_TRUE(cured.recording.usable());
  EXPECT_THAT(cured.text, IsEmpty());
}

TEST(FreeSwing, AStatedScaleIsTakenAndNoted) {
  const auto told = read_swing(", unit = \"rad\", scale = 1.0", "", swing(57.29578));
  EXPECT_TRUE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("more than one turn"));
}

TEST(FreeSwing, TheStatedReleaseTellsTheUnitOfASmallSwing) {
  // 0.049 rad are 2.8 degrees, which stay within one turn in either unit.
  const auto small = [](double per_rad) { return swing(0.14 * per_rad); };
  const std::string release = "release_position_rad = 0.0489\n";
  EXPECT_THAT(read_swing("", release, small(57.29578)).text, HasSubstr("no farther than that"));
  EXPECT_THAT(read_swing("", release, small(1.0)).text, IsEmpty());
  const auto twice = read_swing(", unit = \"deg\", scale = 0.0174532925", release, small(1.0));
  EXPECT_THAT(twice.text, HasSubstr("times that; taken as stated"));
}

// 4.2 rad to either side and back are 8.4 rad, more than one turn and less than two.
TEST(FreeSwing, MoreThanOneTurnAndBackIsDoubted) {
  EXPECT_THAT(read_swing("", "", swing(4.2 / 0.349)).text, HasSubstr("more than one turn"));
}

// The first angle may be off by a fifth: the zero, and rows that are cut.
TEST(FreeSwing, AFirstAngleWithinAFifthOfTheReleaseInDegreesIsTakenForIt) {
  const auto told = [](double share) {  // 2.8 degrees were released, and the angle is scaled twice
    return read_swing(", unit = \"rad\", scale = 1.0",
                      fmt::format("release_position_rad = {}\n", 0.0489 * 57.29578 / share), swing(0.14))
        .text;
  };
  EXPECT_THAT(told(1.15), HasSubstr("times that"));
  EXPECT_THAT(told(1.30), Not(HasSubstr("times that")));
}

TEST(FreeSwing, WhatMayTurnSeveralTimesIsNotDoubted) {
  const auto degrees = swing(57.29578);
  EXPECT_THAT(read_swing("", "", degrees, "").text, IsEmpty()) << "a balanced wheel";
  EXPECT_THAT(read_swing("", "profile = \"sine\"\n", degrees).text, IsEmpty()) << "it is driven";
  EXPECT_THAT(read_swing("", "", swing(1.0, 5.0)).text, IsEmpty()) << "it goes round in one direction";
  auto spike = swing(1.0);
  spike.replace(spike.find("2.000,"), 6, "2.000,9");  // a digit too many
  EXPECT_THAT(read_swing("", "", spike).text, Not(HasSubstr("turn")));
}

// A plate of 50 mm in sand of 4000 N/m.
std::string push(double per_N, const std::string& name = "F") {
  std::string csv = "t,z," + name + "\n";
  for (int i = 0; i < 200; ++i) {
    const double depth_m = 0.00015 * i;
    csv += fmt::format("{:.3f},{:.6f},{:.7f}\n", 0.05 * i, -depth_m,
                       per_N * (4000.0 * depth_m + 0.05 * std::sin(90.0 * i * i)));
  }
  return csv;
}

Told read_push(const std::string& mapping, const std::string& csv, double stiffness_N_per_m,
               const std::string& name = "F") {
  const auto nominal = stiffness_N_per_m > 0.0
                           ? fmt::format("[terrain]\nstiffness_N_per_m = {:.6f}\n", stiffness_N_per_m)
                           : "";
  return read_with(fmt::format("plant = \"intruder\"\n[columns]\nt_s = {{ column = \"t\", unit = \"s\" }}\n"
                               "foot_z_m = {{ column = \"z\", unit = \"m\" }}\n"
                               "force_N = {{ column = \"{}\"{} }}\n",
                               name, mapping),
                   nominal, "kind = \"intrusion\"\nplate_diameter_m = 0.05\n", csv);
}

TEST(ForceUnit, KilonewtonsTakenForNewtonsAreToldByTheStiffnessOrTheGrains) {
  for (const double stiffness : {4000.0, 0.0}) {
    const auto assumed = read_push("", push(1e-3), stiffness);
    EXPECT_FALSE(assumed.recording.usable()) << stiffness;
    EXPECT_THAT(assumed.text, HasSubstr("unit = \"kN\", scale = 1000")) << stiffness;
    const auto stated = read_push(", unit = \"N\", scale = 1.0", push(1e-3), stiffness);
    EXPECT_TRUE(stated.recording.usable());
    EXPECT_THAT(stated.text, HasSubstr("at a depth of")) << stiffness;
    EXPECT_THAT(read_push(", unit = \"kN\", scale = 1000", push(1e-3), stiffness).text, IsEmpty());
    EXPECT_THAT(read_push("", push(1.0), stiffness).text, IsEmpty());
  }
  EXPECT_THAT(read_push("", push(1.0), 800.0).text, IsEmpty()) << "a bed five times as stiff as believed";
  EXPECT_THAT(read_push(", unit = \"N\"", push(1.0), 4.0).text, HasSubstr("N/mm?"));
}

// The limit is the geometric mean of N and kN: a factor of 31.6.
TEST(ForceUnit, AStiffnessIsDoubtedFromAThirtyfoldErrorOn) {
  EXPECT_THAT(read_push("", push(1.0), 4000.0 * 25.0).text, IsEmpty());
  EXPECT_THAT(read_push("", push(1.0), 4000.0 * 45.0).text, HasSubstr("at a depth of"));
}

TEST(StatedUnit, AUnitInTheFileThatIsOverruledIsNoted) {
  const auto told = read_push(", unit = \"N\", scale = 1.0", push(1.0, "F (kN)"), 4000.0, "F (kN)");
  EXPECT_TRUE(told.recording.usable());
  EXPECT_THAT(told.text, HasSubstr("its name says \"kN\", and [columns] overrules it"));
  for (const auto* sound : {", unit = \"kN\", scale = 1000", ", unit = \"kN\", scale = 1050"})
    EXPECT_THAT(read_push(sound, push(1e-3, "F (kN)"), 4000.0, "F (kN)").text, IsEmpty()) << sound;
}

}  // namespace
}  // namespace sandhopper
