#pragma once
#include <sys/types.h>

#include "drivers/can/torque_cut.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {

// A process that does nothing but wait for this one to die, however it does: killed, crashed, out of memory.
// It then takes the torque away for a tenth of a second and ends. Ended in order, it is sent home unused.
class GuardProcess {
 public:
  // Forks; throws std::system_error when that fails. `cut` is used in the child only.
  explicit GuardProcess(TorqueCut& cut);
  ~GuardProcess();
  GuardProcess(const GuardProcess&) = delete;
  GuardProcess& operator=(const GuardProcess&) = delete;

  // It takes the torque away now, as if this process had died, and is not dismissed any more.
  void take_over() noexcept { line_ = {}; }

 private:
  UniqueFd line_;  // the child reads its other end: a byte dismisses it, the end of the line is a death
  pid_t child_ = -1;
};

}  // namespace sandhopper
