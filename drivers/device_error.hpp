#pragma once
#include <stdexcept>
#include <string>
#include <string_view>

namespace sandhopper {

// A device that cannot be used, found when starting: which one, what went wrong, and what to do about it.
class DeviceError : public std::runtime_error {
 public:
  DeviceError(std::string_view device, std::string_view cause, std::string_view cure);
  const std::string& cause() const noexcept { return cause_; }
  const std::string& cure() const noexcept { return cure_; }

 private:
  std::string cause_;
  std::string cure_;
};

// "cannot open: No such file or directory" from the present errno.
std::string errno_cause(std::string_view action);

}  // namespace sandhopper
