#pragma once
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

namespace sandhopper {

// Calls `step` until destroyed. A step waits for its device by itself, for at most some tens of milliseconds,
// and does not throw. Priority 0: ordinary scheduling, else SCHED_FIFO. Throws DeviceError when the kernel
// refuses it.
class AcquisitionThread {
 public:
  struct Setup {
    std::string name;  // at most 15 characters
    int priority = 0;
  };
  AcquisitionThread(const Setup& setup, std::function<void()> step);

 private:
  std::jthread thread_;
};

}  // namespace sandhopper
