#include "tools/plant/load_world.hpp"

#include <algorithm>
#include <utility>

#include "config/load.hpp"

namespace sandhopper {

WorldConfig load_world(const std::filesystem::path& directory, const RobotConfig& robot) {
  return load_world_file(directory / "world.toml", robot);
}

namespace {

// The family named in the document gives default values for the keys of [bed_family]. An invalid name is left
// to the reader, which reports it.
BedFamilyParameters named_family(const ConfigDocument& document) {
  const ConfigNode* table = document.root.find("bed_family");
  const ConfigNode* name = table != nullptr ? table->find("family") : nullptr;
  const auto& names = EnumNames<BedFamily>::value;
  const auto at = name != nullptr ? std::ranges::find(names, name->text) : names.end();
  return at == names.end() ? BedFamilyParameters{}
                           : bed_family_of(static_cast<BedFamily>(at - names.begin()));
}

}  // namespace

WorldConfig load_world_file(const std::filesystem::path& file, WorldConfig base) {
  const auto document = parse_config_file(file.string());
  base.bed_family = named_family(document);
  return load_document<WorldConfig>(document, MissingKeys::use_default, std::move(base));
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
  return load_world_file(file, std::move(world));
}

}  // namespace sandhopper
