#include <optional>

#include "config/dump.hpp"
#include "config/files.hpp"
#include "drivers/can/torque_cut.hpp"
#include "firmware/instance_lock.hpp"
#include "firmware/linux_board.hpp"
#include "firmware/watchdog/guard_process.hpp"
#include "firmware/watchdog/shared.hpp"
#include "firmware/watchdog/torque_watchdog.hpp"
#include "tools/calibrate/board_run.hpp"
#include "tools/virtual_bench/control_client.hpp"

namespace sandhopper::calibrate {
namespace {

// Command to the virtual bench, for example "hold load_N=9.81 …".
std::string bench_line(const Fixture& fixture) {
  std::string line = "hold";
  for (const auto& child : to_node(fixture).children) {
    auto word = to_toml_line(child.key, child);
    std::erase(word, ' ');
    line += " " + word;
  }
  return line;
}

class LinuxRecorder : public Recorder {
 public:
  explicit LinuxRecorder(const RecorderSetup& setup)
      : setup_(setup), lock_(setup.board.can.interface), board_(setup.board) {
    board_.heed(*heart_);
  }

  Recording record(const Step& step, const std::filesystem::path& log) override {
    if (std::string_view(board_file()) == "bench.toml") bench::tell_bench(bench_line(step.fixture));
    BoardRun run{.setup = setup_, .board = board_, .time = monotonic_time(), .board_name = "linux"};
    if (!step.torque_Nm) return run_board(run, step, log);
    TorqueCut cut(setup_.board.can);
    const GuardProcess guard({.cut = cut, .heart = *heart_, .config = setup_.robot.watchdog});
    const TorqueWatchdog watchdog(setup_.robot.watchdog, *heart_, [&cut] { cut.cut(); });
    run.heart = &*heart_;
    return run_board(run, step, log);
  }

 private:
  RecorderSetup setup_;
  InstanceLock lock_;
  Shared<Heartbeat> heart_;
  LinuxBoard board_;
};

}  // namespace

std::unique_ptr<Recorder> make_linux_recorder(const RecorderSetup& setup) {
  return std::make_unique<LinuxRecorder>(setup);
}

}  // namespace sandhopper::calibrate
