#pragma once
#include <filesystem>
#include <string>

namespace sandhopper {

// Where the configuration lies: `option` if not empty (what the user named), else $SANDHOPPER_CONFIG, else
// the first `config/` with a robot.toml found upward from the running program, else /etc/sandhopper. Throws
// ConfigError when there is none, saying what was tried.
std::filesystem::path find_config_directory(const std::string& option = "");

}  // namespace sandhopper
