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
  std::int64_t realtime_offset_ns = 0;  // date of the trial's start
  double longest_s = 60.0;              // a trial that has not ended by then is stopped
  std::function<void(double time_s)> progress{};
};

struct SimTrialResult {
  State last_state = State::idle;
  Fault last_fault = Fault::none;
  std::uint64_t cycles = 0;
};

// A whole trial in the simulated world, as fast as it goes: arm, release, hop, soft stop; logged like a real
// one, with the truth beside it. The same setup gives the same bytes.
SimTrialResult run_sim_trial(const SimTrialSetup& setup);

// Into the log, before it starts: robot, world, seed, release height.
void describe_simulated_trial(TrialLogger& logger, const SimTrialSetup& setup);

}  // namespace sandhopper
