#pragma once
#include <string>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// The kernel's watchdog (Documentation/watchdog/watchdog-api.rst): it resets the computer unless it is fed.
// An orderly end disarms it ('V' before the close); a program that dies leaves it armed.
class KernelWatchdog {
 public:
  // Opening arms it. If there is none, or its timeout cannot be set, warning() has the cause and the cure.
  KernelWatchdog(const std::string& device, int timeout_s);
  ~KernelWatchdog();
  KernelWatchdog(const KernelWatchdog&) = delete;
  KernelWatchdog& operator=(const KernelWatchdog&) = delete;

  void feed() noexcept;
  bool armed() const noexcept { return static_cast<bool>(fd_); }
  int timeout_s() const noexcept { return timeout_s_; }  // timeout that the driver accepted
  const std::string& warning() const noexcept { return warning_; }

 private:
  UniqueFd fd_;
  int timeout_s_;
  std::string warning_;
};

}  // namespace sandhopper
