#include "firmware/watchdog/kernel_watchdog.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/watchdog.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace sandhopper {

KernelWatchdog::KernelWatchdog(const std::string& device, int timeout_s) : timeout_s_(timeout_s) {
  if (device.empty()) return;
  fd_ = UniqueFd(::open(device.c_str(), O_WRONLY | O_CLOEXEC));
  if (!fd_) {
    warning_ = fmt::format(
        "no kernel watchdog ({}: {}): a computer that hangs is not reset; load its driver (or softdog), give "
        "this user the device, or set watchdog.device = \"\"",
        device, std::strerror(errno));
    return;
  }
  if (::ioctl(fd_.get(), WDIOC_SETTIMEOUT, &timeout_s_) != 0)
    warning_ = fmt::format("{} takes no time-out ({}): it keeps its own", device, std::strerror(errno));
}

KernelWatchdog::~KernelWatchdog() {
  if (fd_) [[maybe_unused]]
    const auto disarmed = ::write(fd_.get(), "V", 1);
}

// Any byte except 'V' feeds the watchdog.
void KernelWatchdog::feed() noexcept {
  if (fd_) [[maybe_unused]]
    const auto fed = ::write(fd_.get(), "\0", 1);
}

}  // namespace sandhopper
