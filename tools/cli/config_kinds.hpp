#pragma once
#include <string>

#include "config/node.hpp"
#include "config/robot_config.hpp"

namespace sandhopper::cli {

// A kind of configuration file, recognised by the start of its name: "robot.toml", "robot-long-leg.toml".
struct ConfigKind {
  std::string_view name;
  std::string_view about;
  // Reads the file strictly and returns every key as the program understands it. Throws ConfigError.
  ConfigNode (*load)(const std::string& path);
  // As `load`; also rejects values that contradict each other or, in a device file, the robot. Null: this
  // kind has no such rules.
  ConfigNode (*check)(const std::string& path, const RobotConfig* robot);
};

// Throws ConfigError if the name starts with no known kind.
const ConfigKind& kind_of_file(const std::string& path);

}  // namespace sandhopper::cli
