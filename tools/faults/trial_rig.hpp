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

// A simulated robot in virtual time with the robot's own cycle, driver and log. It requests arming and
// release itself if `phase` needs them. Faults are planted between two cycles.
class TrialRig {
 public:
  TrialRig(const MatrixSetup& setup, const RobotConfig& robot, Phase phase, std::filesystem::path log);
  ~TrialRig();

  // Number of the present cycle in this session, missed cycles included; the first is 1.
  std::uint64_t cycle() const { return cycle_number_; }
  // Number of cycles of this session that ran.
  std::uint64_t turns() const { return turns_; }
  // Present time of the world; it continues over sessions.
  double time_s() const;
  // The last cycle's, also if it ran in an earlier session.
  const StepOutput& output() const { return output_; }
  const SensorFrame& frame() const;
  // Events of the last cycle.
  std::span<const Event> events() const;
  BenchBoard& board() { return board_; }
  const std::filesystem::path& log() const { return log_; }

  // Runs one cycle: read, step, write, log. `request`: the operator's request; none: the rig's own.
  void turn(Request request = Request::none);
  // True in the cycle after which a fault is to be planted in the phase.
  bool ready_to_break() const;
  // Plants a fault in a device or in the computer. Returns the first cycle that can read it.
  std::uint64_t set(Device device, Kind kind);
  // Ends the present session and begins a new one on the same devices, whose defects stay. `phase`: phase
  // that the new session goes for. Returns why the driver refused to start, or nothing.
  std::optional<std::string> restart(Phase phase);
  // Stops the logger and closes its files. Returns the error of the disk as text; empty: none.
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
  StepOutput output_;
  std::int64_t origin_ns_ = 0;  // time of the session's cycle 0
  std::uint64_t cycle_number_ = 0, turns_ = 0, armed_at_ = 0, in_phase_cycles_ = 0;
  std::uint32_t overruns_ = 0;
  bool ready_ = false;
  // Faults of the computer.
  bool overrunning_ = false;
  bool stalls_ = false, watchdog_trips_ = false, clock_steps_ = false;  // in effect in the next cycle only
  bool disk_full_ = false;
};

// The events of a log, read back from its file; empty when the file cannot be read.
std::vector<Event> events_in(const std::filesystem::path& log);

}  // namespace sandhopper::faults
