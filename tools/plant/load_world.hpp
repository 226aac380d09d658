#pragma once
#include <filesystem>

#include "config/robot_config.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper {

// The world the robot of this configuration lives in: its leg, neutral lengths and torque constants,
// everything else as in `directory`/world.toml, whose keys may each be left out. A leg key there makes the
// simulated robot another one than the firmware believes. Throws ConfigError.
WorldConfig load_world(const std::filesystem::path& directory, const RobotConfig& robot);

// What `file` leaves out is as in `base`; but a key of [bed_family] has the value of the family named there.
// Throws ConfigError.
WorldConfig load_world_file(const std::filesystem::path& file, WorldConfig base);

// As the first, from any file.
WorldConfig load_world_file(const std::filesystem::path& file, const RobotConfig& robot);

}  // namespace sandhopper
