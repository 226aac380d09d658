#include <algorithm>
#include <filesystem>
#include <optional>

#include "config/dump.hpp"
#include "config/json.hpp"
#include "config/load.hpp"
#include "config/motor_presets.hpp"
#include "config/problem.hpp"
#include "config/robot_config.hpp"
#include "tools/cli/config_kinds.hpp"
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {
namespace {

std::vector<std::string> files_to_read(Session& session, const std::vector<std::string>& named) {
  if (!named.empty()) return named;
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(session.config_directory()))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw Failure(ExitCode::usage, "no .toml file in " + session.config_directory().string(),
                  "name files, or another directory with --config DIR");
  return files;
}

std::size_t count_keys(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::table && node.kind != ConfigNode::Kind::array) return 1;
  if (node.kind == ConfigNode::Kind::array &&
      (node.children.empty() || node.children.front().kind != ConfigNode::Kind::table))
    return 1;
  std::size_t count = 0;
  for (const auto& child : node.children) count += count_keys(child);
  return count;
}

// Robot that the device files are checked against: the first robot file among `files`, otherwise robot.toml
// beside the first file, otherwise that of the configuration directory. Empty if it cannot be read: its own
// check reports the problems.
std::optional<RobotConfig> robot_for(Session& session, const std::vector<std::string>& files) {
  namespace fs = std::filesystem;
  try {
    const auto named = std::ranges::find_if(
        files, [](const std::string& file) { return kind_of_file(file).name == "robot"; });
    auto file =
        named != files.end() ? fs::path(*named) : fs::path(files.front()).parent_path() / "robot.toml";
    if (!fs::exists(file)) file = session.config_file("robot.toml");
    return load_file<RobotConfig>(file.string());
  } catch (const ConfigError&) {
    return std::nullopt;
  }
}

ConfigNode checked(const std::string& file, const RobotConfig* robot) {
  const auto& kind = kind_of_file(file);
  return kind.check == nullptr ? kind.load(file) : kind.check(file, robot);
}

ExitCode check(Session& session, const std::vector<std::string>& named) {
  std::vector<ConfigProblem> problems;
  std::vector<std::pair<std::string, std::size_t>> right;
  const auto files = files_to_read(session, named);
  const auto robot = robot_for(session, files);
  for (const auto& file : files) {
    try {
      right.emplace_back(file, count_keys(checked(file, robot ? &*robot : nullptr)));
    } catch (const ConfigError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw ConfigError(problems);
  session.result["files"] = nlohmann::ordered_json::array();
  for (const auto& [file, keys] : right) {
    session.say("{}: right, {} keys", file, keys);
    session.result["files"].push_back({{"file", file}, {"keys", keys}});
  }
  return ExitCode::ok;
}

ExitCode show(Session& session, const std::vector<std::string>& named) {
  for (const auto& file : files_to_read(session, named)) {
    const auto node = kind_of_file(file).load(file);
    session.say("# {}\n{}", file, to_toml(node));
    session.result[file] = to_json(node);
  }
  return ExitCode::ok;
}

// Without a name it lists the presets.
ExitCode motor(Session& session, const std::string& name) {
  std::string names;
  session.result["presets"] = nlohmann::ordered_json::object();
  for (const auto& preset : motor_presets()) {
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
    if (!name.empty() && name != preset.name) continue;
    if (!name.empty()) session.say_line(to_toml(preset));
    session.result["presets"][std::string(preset.name)] = to_toml(preset);
  }
  if (name.empty()) session.say("{}", names);
  if (session.result["presets"].empty())
    throw Failure(ExitCode::usage, fmt::format("no preset '{}'", name), "name one of " + names);
  return ExitCode::ok;
}

Run set_up(Arguments& arguments) {
  auto preset = std::make_shared<std::string>();
  auto files = std::make_shared<std::vector<std::string>>();
  arguments.require_verb();
  auto checking = arguments.add_verb("check", "say whether the files are right, and what is wrong where");
  auto showing = arguments.add_verb("show", "print every key as the program understands it");
  for (auto sub : {checking, showing})
    sub.add_option("FILES", *files, "TOML files; default: all of the configuration directory");
  auto presets =
      arguments.add_verb("motor", "print the keys of a motor that follow from its make, with their sources");
  presets.add_option("NAME", *preset, "AK60-6, AK80-6, AK80-9, AK10-9 or \"R80 KV110\"; default: list them");
  return [files, preset, checking, presets](Session& session) {
    if (presets.parsed()) return motor(session, *preset);
    return checking.parsed() ? check(session, *files) : show(session, *files);
  };
}

const VerbRegistration kConfig("config", set_up);

}  // namespace
}  // namespace sandhopper::cli
