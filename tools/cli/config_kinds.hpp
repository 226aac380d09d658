#pragma once
#include <string>

#include "config/node.hpp"

namespace sandhopper::cli {

// A kind of configuration file, told by how its name starts: "robot.toml", "robot-long-leg.toml".
struct ConfigKind {
  std::string_view name;
  std::string_view about;
  // Reads the file strictly and gives it back as the program understood it. Throws ConfigError.
  ConfigNode (*load)(const std::string& path);
};

// Throws ConfigError for a name that starts like no kind.
const ConfigKind& kind_of_file(const std::string& path);

}  // namespace sandhopper::cli
