#pragma once
#include <filesystem>

#include "config/robot_config.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper {

// World of the simulated robot: leg, neutral lengths and torque constants from the robot's configuration, the
// rest from `directory`/world.toml, in which every key is optional. A leg key in world.toml makes the
// simulated leg differ from the firmware's model. Throws ConfigError.
WorldConfig load_world(const std::filesystem::path& directory, const RobotConfig& robot);

// Keys missing in `file` are taken from `base`, but those of [bed_family] from the family named there. Throws
// ConfigError.
WorldConfig load_world_file(const std::filesystem::path& file, WorldConfig base);

// The same as load_world, from any file.
WorldConfig load_world_file(const std::filesystem::path& file, const RobotConfig& robot);

}  // namespace sandhopper
