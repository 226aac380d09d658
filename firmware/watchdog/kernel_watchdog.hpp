#pragma once
#include <string>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// The kernel's watchdog (Documentation/watchdog/watchdog-api.rst): resets the computer unless fed. Ended in
// order it is disarmed ('V' before the close); a program that dies leaves it armed.
class KernelWatchdog {
 public:
  // Opening arms it. Where there is none, or it takes no time-out, warning() says so with a cure.
  KernelWatchdog(const std::string& device, int timeout_s);
  ~KernelWatchdog();
  KernelWatchdog(const KernelWatchdog&) = delete;
  KernelWatchdog& operator=(const KernelWatchdog&) = delete;

  void feed() noexcept;
  bool armed() const noexcept { return static_cast<bool>(fd_); }
  int timeout_s() const noexcept { return timeout_s_; }  // as the driver took it
  const std::string& warning() const noexcept { return warning_; }

 private:
  UniqueFd fd_;
  int timeout_s_;
  std::string warning_;
};

}  // namespace sandhopper
