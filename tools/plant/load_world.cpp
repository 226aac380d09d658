#include "tools/plant/load_world.hpp"

#include "config/load.hpp"

namespace sandhopper {

WorldConfig load_world(const std::filesystem::path& directory, const RobotConfig& robot) {
  return load_world_file(directory / "world.toml", robot);
}

WorldConfig load_world_file(const std::filesystem::path& file, const RobotConfig& robot) {
  WorldConfig world;
  world.robot.leg = robot.robot;
  const auto& c = robot.controller;
  world.controller.compression_length_m = c.compression_length_m;
  world.controller.extension_length_m = c.extension_length_m;
  world.controller.extension_stiffness_N_per_m = c.extension_stiffness_N_per_m;
  world.controller.stance_damping_N_s_per_m = c.stance_damping_N_s_per_m;
  world.controller.flight_stiffness_N_per_m = c.flight_stiffness_N_per_m;
  world.controller.flight_damping_N_s_per_m = c.flight_damping_N_s_per_m;
  world.motor.torque_constant_Nm_per_A = robot.motor[0].torque_constant_Nm_per_A;
  return load_file<WorldConfig>(file.string(), MissingKeys::use_default, world);
}

}  // namespace sandhopper
