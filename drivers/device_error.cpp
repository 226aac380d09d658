#include "drivers/device_error.hpp"

#include <cerrno>
#include <system_error>

namespace sandhopper {

namespace {
std::string sentence(std::string_view device, std::string_view cause, std::string_view cure) {
  std::string text(device);
  text.append(": ").append(cause).append(cause.ends_with('\n') ? "" : ". ").append(cure);
  return text;
}
}  // namespace

DeviceError::DeviceError(std::string_view device, std::string_view cause, std::string_view cure)
    : std::runtime_error(sentence(device, cause, cure)), cause_(cause), cure_(cure) {}

std::string errno_cause(std::string_view action) {
  const int error = errno;
  return std::string(action) + ": " + std::generic_category().message(error);
}

}  // namespace sandhopper
