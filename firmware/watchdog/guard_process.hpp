#pragma once
#include <sys/types.h>

#include "drivers/can/torque_cut.hpp"
#include "drivers/unique_fd.hpp"
#include "firmware/watchdog/heartbeat.hpp"
#include "firmware/watchdog/last_act.hpp"
#include "firmware/watchdog/watchdog_config.hpp"

namespace sandhopper {

// A child process that cuts the torque when this process dies (crash, SIGKILL, out of memory) or stands still
// as a whole (SIGSTOP, Ctrl-Z, a debugger). In the second case the torque watchdog's thread stands still with
// the cycle.
//   - Death: cuts within a millisecond, then every millisecond for 100 ms; runs the last act and ends.
//   - Standstill: the cycle has beaten and then misses its beat for 1.5 cycle_stall_s. The child checks every
//     quarter of cycle_stall_s. It stores a trip in the heartbeat and cuts at each check until the cycle
//     beats again and has taken the trip. The trip leads to the fault watchdog_tripped.
//   - Not dismissed 0.5 s after the cycle's end: it cuts at each check until it is dismissed.
// It sends only the frames of TorqueCut: zero torque, leave motor mode. It ignores every signal that can be
// ignored and has a session of its own (Ctrl-C and Ctrl-Z do not reach it). As far as permitted, it runs with
// SCHED_FIFO at the watchdog's priority and locks its memory.
// watchdog's priority and locks its memory, as far as the machine grants that.
class GuardProcess {
 public:
  struct Setup {
    TorqueCut& cut;               // used in the child only
    Heartbeat& heart;             // in memory shared with the child: Shared<Heartbeat>
    WatchdogConfig config;        // cycle_stall_s, priority
    LastAct* last_act = nullptr;  // may be null
  };

  // Forks; throws std::system_error when that fails.
  explicit GuardProcess(const Setup& setup);
  // Dismisses the child unless abandon() was called, and waits for its end.
  ~GuardProcess();
  GuardProcess(const GuardProcess&) = delete;
  GuardProcess& operator=(const GuardProcess&) = delete;

  // For drives that were not confirmed off: the child acts as after the death of this process.
  void abandon() noexcept { line_ = UniqueFd(); }

  // False after the child has ended, for example because it was killed. Then a standstill or a death of this
  // process would not cut the torque. Also reaps the child.
  bool alive() noexcept;

  pid_t process_id() const noexcept { return child_; }

 private:
  UniqueFd line_;  // the child reads the other end: a byte dismisses it, the end of the connection means
                   // death
  pid_t child_ = -1;
};

}  // namespace sandhopper
