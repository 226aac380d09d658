#pragma once
#include <filesystem>
#include <string>

namespace sandhopper {

// Finds the configuration directory: `option` if it is not empty (given by the user), otherwise
// $SANDHOPPER_CONFIG, otherwise the first `config/` with a robot.toml upward from the running program,
// otherwise /etc/sandhopper. Throws ConfigError with the places tried if there is none.
std::filesystem::path find_config_directory(const std::string& option = "");

}  // namespace sandhopper
