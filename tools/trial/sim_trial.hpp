#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "config/robot_config.hpp"
#include "firmware/log/trial_logger.hpp"
#include "firmware/log/trial_sheet.hpp"
#include "firmware/records.hpp"
#include "tools/plant/world.hpp"

namespace sandhopper {

struct SimTrialSetup {
  RobotConfig robot{};
  WorldConfig world{};
  TrialSetup trial{};
  std::optional<TrialSheet> sheet{};
  std::filesystem::path log;            // .mcap
  std::int64_t realtime_offset_ns = 0;  // date of the trial's start: CLOCK_REALTIME minus the trial's time
  double longest_s = 60.0;              // a trial that lasts longer is stopped
  std::function<void(double time_s)> progress{};
};

struct SimTrialResult {
  State last_state = State::idle;
  Fault last_fault = Fault::none;
  std::uint64_t cycles = 0;
};

// Runs a complete trial in the simulated world, as fast as possible: arm, release, hop, soft stop. It is
// logged like a real one, with the true values in addition. Equal set-ups give equal bytes.
SimTrialResult run_sim_trial(const SimTrialSetup& setup);

// Adds robot, world, seed and release height to the log. Call it before the log starts.
void describe_simulated_trial(TrialLogger& logger, const SimTrialSetup& setup);

}  // namespace sandhopper
