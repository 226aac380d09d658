#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "config/dump.hpp"
#include "config/problem.hpp"
#include "tools/cli/doctor.hpp"

namespace sandhopper::cli {
namespace {

// Node of a key such as "motor[1].sign".
const ConfigNode* find(const ConfigNode* node, std::string_view key) {
  while (node != nullptr && !key.empty()) {
    if (key.starts_with('[')) {
      std::size_t index = 0;
      const auto end = key.find(']');
      std::from_chars(key.data() + 1, key.data() + end, index);
      node = index < node->children.size() ? &node->children[index] : nullptr;
      key.remove_prefix(end + 1);
    } else {
      const auto end = key.find_first_of(".[");
      node = node->find(key.substr(0, end));
      key.remove_prefix(end == std::string_view::npos ? key.size() : end);
    }
    if (key.starts_with('.')) key.remove_prefix(1);
  }
  return node;
}

double number(const ConfigNode& node) {
  return node.kind == ConfigNode::Kind::integer ? static_cast<double>(node.integer) : node.real;
}

// The first key whose value differs from its calibration; empty: none.
std::string edited_since(const CalibrationRecord& record, const ConfigNode& configuration) {
  for (std::size_t i = 0; i < record.keys.size(); ++i) {
    const auto* node = find(&configuration, record.keys[i]);
    if (node == nullptr ||
        std::abs(number(*node) - record.values[i]) > 1e-9 * (1.0 + std::abs(record.values[i])))
      return record.keys[i];
  }
  return {};
}

Finding calibration(const std::string& name, const std::string& verb,
                    const std::optional<CalibrationRecord>& record, const ConfigNode& configuration) {
  const auto what = "calibration " + name;
  const auto cure = "hop calibrate " + verb;
  if (!record) return {Health::warn, what, "never made", cure};
  const auto found =
      fmt::format("{}, residual {} {}", record->date, record->residual_rms, record->residual_unit);
  if (const auto key = edited_since(*record, configuration); !key.empty())
    return {Health::warn, what, fmt::format("{}; {} was changed since", found, key),
            cure + ", or remove the record if the value is right"};
  return {Health::ok, what, found, ""};
}

}  // namespace

std::vector<Finding> examine_calibrations(const RobotConfig& robot, const LinuxBoardConfig& board) {
  const auto robot_node = to_node(robot), board_node = to_node(board);
  const auto r = robot.calibration.value_or(RobotCalibrations{});
  const auto b = board.calibration.value_or(BoardCalibrations{});
  return {calibration("encoders", "encoders", r.encoders, robot_node),
          calibration("load_cell", "load-cell", b.load_cell, board_node),
          calibration("imu_body", "imu --imu body", b.imu_body, board_node),
          calibration("imu_foot", "imu --imu foot", b.imu_foot, board_node),
          calibration("tof", "tof", b.tof, board_node),
          calibration("torque_constant", "torque-constant", r.torque_constant, robot_node),
          calibration("timing", "timing", b.timing, board_node)};
}

std::vector<Finding> examine_problems(const ConfigError& error) {
  std::vector<Finding> out;
  for (const auto& problem : error.problems())
    out.push_back({Health::fail, "configuration",
                   fmt::format("{}:{}:{}: {}", problem.file, problem.position.line, problem.position.column,
                               problem.text),
                   "correct this line, then hop config check"});
  return out;
}

}  // namespace sandhopper::cli
