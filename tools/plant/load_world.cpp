#include "tools/plant/load_world.hpp"

#include "config/load.hpp"

namespace sandhopper {

WorldConfig load_world(const std::filesystem::path& directory, const RobotConfig& robot) {
  WorldConfig world;
  world.robot.leg = robot.robot;
  world.motor.torque_constant_Nm_per_A = robot.motor[0].torque_constant_Nm_per_A;
  return load_file<WorldConfig>((directory / "world.toml").string(), MissingKeys::use_default, world);
}

}  // namespace sandhopper
