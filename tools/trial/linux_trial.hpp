#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "config/robot_config.hpp"
#include "firmware/records.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {

struct LinuxTrialSetup {
  std::filesystem::path config_directory;
  std::filesystem::path devices;  // linux.toml, inside the virtual bench bench.toml
  RobotConfig robot{};
  TrialSetup trial{};  // told to the bench; on a real robot the operator is asked
  std::filesystem::path log;
  std::function<void(const std::string&)> say;
};

struct LinuxTrialResult {
  State last_state = State::idle;
  Fault last_fault = Fault::none;
};

// Runs hopperd on the device nodes as the operator of one trial: arm, release, wait for the end. Throws
// std::runtime_error with hopperd's own message when it does not start.
LinuxTrialResult run_linux_trial(const LinuxTrialSetup& setup);

}  // namespace sandhopper
