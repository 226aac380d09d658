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

  // True if there are bytes to read or the line has failed.
  bool wait(std::int64_t timeout_ns) const noexcept;
  // Returns the number of bytes read; 0 also if the line has failed.
  std::size_t read(std::span<std::uint8_t> bytes) noexcept;
  bool write(std::span<const std::uint8_t> bytes) noexcept;
  void discard_input() noexcept;

 private:
  UniqueFd fd_;
};

}  // namespace sandhopper
