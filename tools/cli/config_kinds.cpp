#include "tools/cli/config_kinds.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "config/files.hpp"
#include "config/load.hpp"
#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"
#include "tools/plant/load_world.hpp"

namespace sandhopper::cli {
namespace {

template <class T, MissingKeys missing>
ConfigNode load(const std::string& path) {
  return to_node(load_file<T>(path, missing));
}

ConfigNode load_world_keys(const std::string& path) { return to_node(load_world_file(path, WorldConfig{})); }

ConfigNode check_robot(const std::string& path, const RobotConfig*) { return to_node(load_robot_file(path)); }

ConfigNode check_board(const std::string& path, const RobotConfig* robot) {
  if (robot == nullptr) return to_node(load_file<LinuxBoardConfig>(path));
  return to_node(load_linux_board(path, *robot));
}

constexpr std::array kKinds{
    ConfigKind{"robot", "the robot and its cycle", load<RobotConfig, MissingKeys::error>, check_robot},
    ConfigKind{"linux", "the robot's device nodes", load<LinuxBoardConfig, MissingKeys::error>, check_board},
    ConfigKind{"bench", "the virtual bench's device nodes", load<LinuxBoardConfig, MissingKeys::error>,
               check_board},
    ConfigKind{"world", "the simulated world", load_world_keys, nullptr},
};

}  // namespace

const ConfigKind& kind_of_file(const std::string& path) {
  if (!std::filesystem::exists(path)) parse_config_file(path);  // throws with the reason
  const auto name = std::filesystem::path(path).filename().string();
  const auto start = name.substr(0, name.find_first_of(".-"));
  for (const auto& kind : kKinds)
    if (kind.name == start) return kind;
  std::string names;
  for (const auto& kind : kKinds)
    names += fmt::format("{}{}*.toml ({})", names.empty() ? "" : ", ", kind.name, kind.about);
  throw ConfigError(
      {{path, {0, 0}, "", fmt::format("its name does not say what it configures: name it {}", names)}});
}

}  // namespace sandhopper::cli
