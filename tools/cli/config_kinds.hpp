#pragma once
#include <string>

#include "config/node.hpp"
#include "config/robot_config.hpp"

namespace sandhopper::cli {

// A kind of configuration file, told by how its name starts: "robot.toml", "robot-long-leg.toml".
struct ConfigKind {
  std::string_view name;
  std::string_view about;
  // Reads the file strictly and gives it back as the program understood it. Throws ConfigError.
  ConfigNode (*load)(const std::string& path);
  // The same, and refuses values that contradict each other or, for a device file, the robot. Null: such a
  // file has no rules of this kind.
  ConfigNode (*check)(const std::string& path, const RobotConfig* robot);
};

// Throws ConfigError for a name that starts like no kind.
const ConfigKind& kind_of_file(const std::string& path);

}  // namespace sandhopper::cli
