#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "firmware/cycle.hpp"
#include "tools/faults/bench_board.hpp"
#include "tools/faults/cell.hpp"
#include "tools/faults/run_cell.hpp"

namespace sandhopper::faults {

// A simulated robot in virtual time with the robot's own cycle, driver and log. It arms and is released by
// itself when `phase` asks for it, and waits in no phase. Faults are set between two cycles.
class TrialRig {
 public:
  TrialRig(const MatrixSetup& setup, const RobotConfig& robot, Phase phase, std::filesystem::path log);
  ~TrialRig();

  // Cycles of the present session; the first is 1.
  std::uint64_t cycle() const { return cycle_number_; }
  // Of them those that ran.
  std::uint64_t turns() const { return turns_; }
  double time_s() const;
  const StepOutput& output() const { return *output_; }
  const SensorFrame& frame() const;
  std::span<const Event> events() const;
  BenchBoard& board() { return board_; }
  const std::filesystem::path& log() const { return log_; }

  // One cycle: read, step, write, log. The operator asks for what the rig itself does not.
  void turn(Request request = Request::none);
  // The phase has lasted as long as a cell waits in it before something breaks.
  bool ready_to_break() const;
  // Breaks a device, or the computer. Returns the first cycle that can read it.
  std::uint64_t set(Device device, Kind kind);
  // Ends the present session and begins another one, which goes for `phase`, on the same devices with what is
  // wrong with them.
  // Returns why the driver refused to start, or nothing.
  std::optional<std::string> restart(Phase phase);
  // Stops the logger and closes its files. Returns the disk's trouble in words; empty when there was none.
  std::string close_log();

 private:
  struct Session;

  void begin_session();
  std::uint64_t missed_cycles();
  Request request() const;
  FileCalls file_calls();

  const MatrixSetup& setup_;
  RobotConfig robot_;
  Phase phase_;
  std::filesystem::path log_;
  World world_;
  BenchBoard board_;
  std::unique_ptr<Session> session_;
  const StepOutput* output_ = nullptr;
  std::int64_t origin_ns_ = 0;  // time of the session's cycle 0
  std::uint64_t cycle_number_ = 0, turns_ = 0, armed_at_ = 0, in_phase_cycles_ = 0;
  std::uint32_t overruns_ = 0;
  bool ready_ = false;
  // What is wrong with the computer.
  bool overrunning_ = false;
  bool stalls_ = false, watchdog_trips_ = false, clock_steps_ = false;  // in the next cycle
  bool disk_full_ = false;
};

// The events of a log, read back from its file; empty when the file cannot be read.
std::vector<Event> events_in(const std::filesystem::path& log);

}  // namespace sandhopper::faults
