#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// A serial line, raw, 8N1, without flow control, non-blocking. Throws DeviceError.
class SerialPort {
 public:
  SerialPort(const std::string& path, int baud);

  // True when there are bytes, or the line has gone.
  bool wait(std::int64_t timeout_ns) const noexcept;
  // How many bytes were there; 0 also when the line has gone.
  std::size_t read(std::span<std::uint8_t> bytes) noexcept;
  bool write(std::span<const std::uint8_t> bytes) noexcept;
  void discard_input() noexcept;

 private:
  UniqueFd fd_;
};

}  // namespace sandhopper
