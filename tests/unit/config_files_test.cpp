#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "config/files.hpp"
#include "config/load.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config";

// Lists keys with their tables; elements of arrays are numbered: "motor[0].can_id".
void list_keys(const ConfigNode& node, const std::string& path, std::set<std::string>& keys) {
  if (node.kind == ConfigNode::Kind::table) {
    for (const auto& child : node.children) list_keys(child, path + "." + child.key, keys);
  } else if (node.kind == ConfigNode::Kind::array && !node.children.empty() &&
             node.children.front().kind == ConfigNode::Kind::table) {
    for (std::size_t i = 0; i < node.children.size(); ++i)
      list_keys(node.children[i], path + "[" + std::to_string(i) + "]", keys);
  } else {
    keys.insert(path.substr(1));
  }
}

std::set<std::string> keys_of(const ConfigNode& node) {
  std::set<std::string> keys;
  list_keys(node, "", keys);
  return keys;
}

template <class T>
void expect_file_lists_the_keys_of(const std::string& name) {
  const auto path = (kConfig / name).string();
  EXPECT_EQ(keys_of(parse_config_file(path).root), keys_of(to_node(T{}))) << path;
  EXPECT_NO_THROW(load_file<T>(path));
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

template <class T>
void expect_same(const T& in_file, const T& in_struct) {
  const auto file = lines_of(to_toml(in_file)), defaults = lines_of(to_toml(in_struct));
  ASSERT_EQ(file.size(), defaults.size());
  for (std::size_t i = 0; i < file.size(); ++i) EXPECT_EQ(file[i], defaults[i]);
}

TEST(ConfigFiles, RobotFileAndStructListTheSameKeys) {
  expect_file_lists_the_keys_of<RobotConfig>("robot.toml");
}

TEST(ConfigFiles, RobotFileHoldsTheStructsDefaults) { expect_same(load_robot(kConfig), RobotConfig{}); }

TEST(ConfigFiles, LinuxFileAndStructListTheSameKeys) {
  expect_file_lists_the_keys_of<LinuxBoardConfig>("linux.toml");
}

TEST(ConfigFiles, LinuxFileHoldsTheStructsDefaults) {
  expect_same(load_file<LinuxBoardConfig>((kConfig / "linux.toml").string()), LinuxBoardConfig{});
}

TEST(ConfigFiles, BenchFileAndStructListTheSameKeys) {
  expect_file_lists_the_keys_of<LinuxBoardConfig>("bench.toml");
}

TEST(ConfigFiles, BenchDiffersFromTheRobotOnlyInTheCanInterfaceAndAges) {
  const auto robot = load_file<LinuxBoardConfig>((kConfig / "linux.toml").string());
  auto bench = load_file<LinuxBoardConfig>((kConfig / "bench.toml").string());
  EXPECT_EQ(bench.can.interface, "vcan0");
  bench.can.interface = robot.can.interface;
  bench.imu_body.latency_s = robot.imu_body.latency_s;
  bench.imu_foot.latency_s = robot.imu_foot.latency_s;
  bench.tof.latency_s = robot.tof.latency_s;
  bench.load_cell.latency_s = robot.load_cell.latency_s;
  expect_same(bench, robot);
}

TEST(ConfigFiles, WorldFileLeavesOutOnlyWhatFollowsFromRobotAndFamily) {
  const auto path = (kConfig / "world.toml").string();
  const auto in_file = keys_of(parse_config_file(path).root);
  for (const auto& key : keys_of(to_node(WorldConfig{}))) {
    const bool of_the_leg = keys_of(to_node(LegParameters{})).contains(key.substr(key.find('.') + 1));
    const bool follows = of_the_leg || key.starts_with("controller.") ||
                         key == "motor.torque_constant_Nm_per_A" ||
                         (key.starts_with("bed_family.") && key != "bed_family.family");
    EXPECT_NE(in_file.contains(key), follows) << key;
  }
}

TEST(ConfigFiles, WorldFileHoldsTheStructsDefaults) {
  expect_same(load_world(kConfig, RobotConfig{}), WorldConfig{});
}

TEST(ConfigFiles, TheSimulatedRobotIsThatOfTheRobotFile) {
  RobotConfig robot;
  robot.robot.foot_mass_kg = 0.7;
  robot.motor[0].torque_constant_Nm_per_A = 0.08;
  robot.controller.extension_length_m = 0.33;
  const auto world = load_world(kConfig, robot);
  EXPECT_EQ(world.robot.leg.foot_mass_kg, 0.7);
  EXPECT_EQ(world.motor.torque_constant_Nm_per_A, 0.08);
  EXPECT_EQ(world.controller.extension_length_m, 0.33);
}

TEST(ConfigFiles, TheBoardsMotorsAreThoseOfTheRobotFile) {
  RobotConfig robot;
  robot.motor[1].can_id = 5;
  EXPECT_EQ(load_linux_board(kConfig / "linux.toml", robot).can.motor[1].can_id, 5);
  EXPECT_EQ(cycle_config(robot).torque_constant_Nm_per_A[1], robot.motor[1].torque_constant_Nm_per_A);
}

TEST(ConfigFiles, EveryFileIsTested) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig))
    if (entry.path().extension() == ".toml") files.insert(entry.path().filename().string());
  EXPECT_THAT(files, ::testing::ElementsAre("bench.toml", "linux.toml", "robot.toml", "world.toml"));
}

// A valid file except for one line: the first line that starts with `key` is replaced.
std::string problem_when(const std::string& changes_to, std::string_view table, std::string_view key) {
  auto node = to_node(RobotConfig{});
  auto text = to_toml(node);
  const auto header = text.find("[" + std::string(table) + "]\n");
  const auto start = text.find("\n" + std::string(key) + " = ", header) + 1;
  text.replace(start, text.find('\n', start) - start, std::string(key) + " = " + changes_to);
  try {
    load_text<RobotConfig>("robot.toml", text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(RobotConfigRules, LegThatCannotFoldIsRefused) {
  EXPECT_THAT(problem_when("0.11", "robot", "lower_link_length_m"),
              HasSubstr("'robot.lower_link_length_m' does not fit: expected more than"));
}

TEST(RobotConfigRules, AngleLimitsMustLeaveRoom) {
  EXPECT_THAT(
      problem_when("2.8", "limits", "leg_angle_min_rad"),
      HasSubstr("'limits.leg_angle_min_rad' does not fit: expected less than limits.leg_angle_max_rad"));
}

TEST(RobotConfigRules, NeutralLengthsMustBeWithinReach) {
  EXPECT_THAT(
      problem_when("0.5", "controller", "extension_length_m"),
      AllOf(HasSubstr("'controller.extension_length_m' does not fit"), HasSubstr("0.1260 to 0.3580 m")));
}

TEST(RobotConfigRules, TheTorqueThatProvesMotorModeMustShowInARepliesFieldAndBeWithinTheLimit) {
  EXPECT_THAT(problem_when("0.03", "arming", "confirm_torque_Nm"),
              AllOf(HasSubstr("'arming.confirm_torque_Nm' does not fit: expected at least four steps"),
                    HasSubstr("4 x 2 x 18 / 4095 x gear_ratio = 0.035 N m")));
  EXPECT_THAT(problem_when("2.9", "arming", "confirm_torque_Nm"),
              HasSubstr("expected at most limits.motor_torque_Nm (2.8)"));
}

TEST(RobotConfigRules, ExtensionMustNotPull) {
  EXPECT_THAT(problem_when("0.29", "controller", "extension_length_m"),
              HasSubstr("'controller.extension_length_m' does not fit: expected at least"));
}

TEST(RobotConfigRules, BadSamplesAreNotTrustedMoreThanGoodOnes) {
  EXPECT_THAT(problem_when("0.5", "stiffness.weights", "sigma_bad_N"),
              HasSubstr("'stiffness.weights.sigma_bad_N' does not fit"));
}

TEST(RobotConfigRules, AQuotaThatDoesNotHoldTwoFilesOfTheLogIsRefused) {
  EXPECT_THAT(problem_when("399", "log", "quota_MB"),
              AllOf(HasSubstr("robot.toml:"), HasSubstr("'log.quota_MB' does not fit: expected 0 (none) or"),
                    HasSubstr("got 399; write 400 or more")));
  EXPECT_EQ(problem_when("400", "log", "quota_MB"), "");
  EXPECT_EQ(problem_when("0", "log", "quota_MB"), "");
}

TEST(RobotConfigRules, AQuotaOfALogInOneFileIsRefused) {
  EXPECT_THAT(problem_when("0", "log", "segment_MB"),
              AllOf(HasSubstr("'log.quota_MB' does not fit"), HasSubstr("set segment_MB, too")));
}

TEST(RobotConfigRules, MotorsNeedTheirOwnIds) {
  EXPECT_THAT(problem_when("2", "[motor]", "can_id"),
              HasSubstr("'motor[1].can_id' does not fit: both motors"));
}

}  // namespace
}  // namespace sandhopper
