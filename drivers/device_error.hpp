#pragma once
#include <stdexcept>
#include <string>
#include <string_view>

namespace sandhopper {

// A device that cannot be used at start: which device, the cause, and the cure for the user.
class DeviceError : public std::runtime_error {
 public:
  DeviceError(std::string_view device, std::string_view cause, std::string_view cure);
  const std::string& cause() const noexcept { return cause_; }
  const std::string& cure() const noexcept { return cure_; }

 private:
  std::string cause_;
  std::string cure_;
};

// The action and the text of the current errno, such as "cannot open: No such file or directory".
std::string errno_cause(std::string_view action);

}  // namespace sandhopper
