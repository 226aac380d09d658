#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "drivers/gpio/line_config.hpp"

// Interface between gpio.cpp and libgpiod. libgpiod1.cpp implements it with releases 1.x, libgpiod2.cpp
// with 2.x; CMake compiles the one whose library is installed. Both use the C library: the C++ layers
// allocate for every level they read, and the e-stop is read in the cycle.
namespace sandhopper {

enum class LineUse : std::uint8_t { input, output_inactive, output_active, rising_edges };

// Consumer name of our lines in gpioinfo.
inline constexpr const char* kConsumer = "sandhopper";

// Number of edges that the kernel keeps for a line. Release 1.x cannot ask for more.
inline constexpr std::size_t kEdgeCapacity = 16;

// A requested line. Its functions allocate nothing.
class GpioLine {
 public:
  virtual ~GpioLine() = default;
  // 1: active, 0: inactive, -1: cannot be read.
  virtual int value() noexcept = 0;
  virtual bool set(bool active) noexcept = 0;
  // Waits for an edge and takes up to kEdgeCapacity. Returns how many, 0 after the timeout, -1 when the line
  // cannot be read. `newest_ns` is CLOCK_MONOTONIC.
  virtual int take_edges(std::int64_t timeout_ns, std::int64_t& newest_ns) noexcept = 0;
};

class GpioChip {
 public:
  // Null if `path` cannot be opened or is no GPIO chip; errno has the reason.
  static std::unique_ptr<GpioChip> open(const std::string& path);
  virtual ~GpioChip() = default;

  virtual std::string label() = 0;
  virtual unsigned line_count() = 0;
  // First line with that name.
  virtual std::optional<unsigned> line_named(const std::string& name) = 0;
  // Consumer that holds the line; empty if there is none.
  virtual std::string user_of(unsigned line) = 0;
  // Null if refused; errno has the reason. The line stays valid after the chip is destroyed.
  virtual std::unique_ptr<GpioLine> request(unsigned line, const LineConfig& config, LineUse use) = 0;
};

}  // namespace sandhopper
