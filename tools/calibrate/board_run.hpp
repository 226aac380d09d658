#pragma once
#include <filesystem>

#include "firmware/board.hpp"
#include "firmware/watchdog/heartbeat.hpp"
#include "tools/calibrate/recorder.hpp"

namespace sandhopper::calibrate {

// Runs a board for one step at 1 kHz and records its frames. The first 50 ms are not recorded: filters settle
// and drives are switched on. Switches the drives off and throws std::runtime_error if the watchdog tripped,
// or under torque on the e-stop or on a motor faster than kFastest_radps.
inline constexpr double kFastest_radps = 2.0;
struct BoardRun {
  const RecorderSetup& setup;
  Board& board;
  TimeSource& time;
  std::string board_name;  // "linux" or "sim", written into the log
  Heartbeat* heart = nullptr;
};
Recording run_board(const BoardRun& run, const Step& step, const std::filesystem::path& log);

}  // namespace sandhopper::calibrate
