#pragma once
#include <filesystem>

#include "firmware/board.hpp"
#include "firmware/watchdog/heartbeat.hpp"
#include "tools/calibrate/recorder.hpp"

namespace sandhopper::calibrate {

// A faster motor under torque ends a step.
inline constexpr double kFastest_radps = 2.0;
// The board, clock and log name of a step. `heart`: beats of the cycle for the watchdog; null if there is no
// torque.
struct BoardRun {
  const RecorderSetup& setup;
  Board& board;
  TimeSource& time;
  std::string board_name;  // "linux" or "sim", written into the log
  Heartbeat* heart = nullptr;
};
// Runs a board for one step at 1 kHz and records its frames. The first 50 ms are not recorded: filters settle
// and drives are switched on. Switches the drives off and throws std::runtime_error if the watchdog tripped,
// or under torque on the e-stop or on a motor faster than kFastest_radps.
Recording run_board(const BoardRun& run, const Step& step, const std::filesystem::path& log);

}  // namespace sandhopper::calibrate
