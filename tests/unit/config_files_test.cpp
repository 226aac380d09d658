#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "config/load.hpp"
#include "config/robot_config.hpp"

namespace sandhopper {
namespace {

const std::filesystem::path kConfig = std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config";

// Keys with their tables, an array's element counted like any other: "motor[0].can_id".
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

TEST(ConfigFiles, RobotFileAndStructListTheSameKeys) {
  expect_file_lists_the_keys_of<RobotConfig>("robot.toml");
}

TEST(ConfigFiles, RobotFileHoldsTheStructsDefaults) {
  std::istringstream file(to_toml(load_file<RobotConfig>((kConfig / "robot.toml").string())));
  std::istringstream defaults(to_toml(RobotConfig{}));
  std::string in_file, in_struct;
  while (std::getline(file, in_file) && std::getline(defaults, in_struct)) EXPECT_EQ(in_file, in_struct);
}

TEST(ConfigFiles, EveryFileIsTested) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig))
    if (entry.path().extension() == ".toml") files.insert(entry.path().filename().string());
  EXPECT_THAT(files, ::testing::ElementsAre("robot.toml"));
}

// A file that is right but for one line: the first line that starts with `key` is replaced.
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
              HasSubstr("key 'robot' does not fit: leg: lower"));
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

TEST(RobotConfigRules, ExtensionMustNotPull) {
  EXPECT_THAT(problem_when("0.29", "controller", "extension_length_m"),
              HasSubstr("'controller.extension_length_m' does not fit: expected at least"));
}

TEST(RobotConfigRules, BadSamplesAreNotTrustedMoreThanGoodOnes) {
  EXPECT_THAT(problem_when("0.5", "stiffness.weights", "sigma_bad_N"),
              HasSubstr("'stiffness.weights.sigma_bad_N' does not fit"));
}

}  // namespace
}  // namespace sandhopper
