#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/robot_config.hpp"
#include "firmware/log/trial_sheet.hpp"
#include "firmware/records.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {

struct LinuxTrialSetup {
  std::filesystem::path config_directory;
  std::filesystem::path devices;  // linux.toml, or bench.toml inside the virtual bench
  RobotConfig robot{};
  TrialSetup trial{};  // passed to the bench; on a real robot the operator is asked
  std::optional<TrialSheet> sheet{};
  std::filesystem::path log;
  std::function<void(const std::string&)> say;
};

struct LinuxTrialResult {
  State last_state = State::idle;
  Fault last_fault = Fault::none;
};

// Runs hopperd on the device nodes and acts as the operator of one trial: arm, release, wait for the end.
// Throws std::runtime_error with hopperd's own message if it does not start.
LinuxTrialResult run_linux_trial(const LinuxTrialSetup& setup);

// For a trial with an operator at the keyboard: the command that starts hopperd, and whether the robot is the
// virtual bench's, which is reset for each trial.
std::vector<std::string> daemon_command(const LinuxTrialSetup& setup);
bool on_virtual_bench();
void reset_virtual_bench(const TrialSetup& trial);

}  // namespace sandhopper
