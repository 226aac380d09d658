#pragma once
#include <filesystem>

#include "firmware/board.hpp"
#include "firmware/watchdog/heartbeat.hpp"
#include "tools/calibrate/recorder.hpp"

namespace sandhopper::calibrate {

// Runs a board for one step, a cycle a millisecond, and records its frames. The first 50 ms, in which filters
// settle and drives are switched on, are not recorded. Throws std::runtime_error, with the drives told to go
// off, on the e-stop and on a motor that moves faster than kFastest_radps while there is torque.
inline constexpr double kFastest_radps = 2.0;
struct BoardRun {
  const RecorderSetup& setup;
  Board& board;
  TimeSource& time;
  std::string board_name;  // "linux" or "sim", for the log
  Heartbeat* heart = nullptr;
};
Recording run_board(const BoardRun& run, const Step& step, const std::filesystem::path& log);

}  // namespace sandhopper::calibrate
