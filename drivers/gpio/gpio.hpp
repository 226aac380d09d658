#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "drivers/gpio/line_config.hpp"

// GPIO lines through libgpiod 1.x or 2.x; only libgpiod1.cpp and libgpiod2.cpp know the library. `role` names
// the line in messages. Constructors throw DeviceError.
namespace sandhopper {

class GpioLine;

// A level that is read each cycle, such as the e-stop. With `active_low`, a normally closed switch and a
// pull-down, a cut wire reads active. A line that cannot be read also reads active.
class GpioInput {
 public:
  GpioInput(std::string_view role, const LineConfig& config);
  ~GpioInput();
  GpioInput(GpioInput&&) noexcept;
  bool active() noexcept;

 private:
  std::unique_ptr<GpioLine> line_;
};

class GpioOutput {
 public:
  GpioOutput(std::string_view role, const LineConfig& config, bool initially_active);
  ~GpioOutput();
  GpioOutput(GpioOutput&&) noexcept;
  // Writes only if the level changes; false if the write failed.
  bool set(bool active) noexcept;

 private:
  std::unique_ptr<GpioLine> line_;
  bool active_;
};

// Edges of a data-ready line with the kernel's CLOCK_MONOTONIC time of the interrupt.
class GpioEdges {
 public:
  struct Edge {
    std::int64_t time_ns;  // time of the newest edge
    std::uint32_t count;   // number of edges taken from the queue
  };

  // Reports edges from inactive to active.
  GpioEdges(std::string_view role, const LineConfig& config);
  ~GpioEdges();
  GpioEdges(GpioEdges&&) noexcept;

  // Waits for an edge, then empties the queue. The kernel keeps 16 edges. On overflow it drops the newest
  // with libgpiod 1.x and the oldest with 2.x.
  std::optional<Edge> wait(std::int64_t timeout_ns) noexcept;

  // The level now; true when it cannot be read.
  bool active() noexcept;

 private:
  std::unique_ptr<GpioLine> line_;
};

// Name of the process that holds the line, empty if none does. Does not take the line or change its
// direction.
std::string user_of_gpio_line(std::string_view role, const LineConfig& config);

}  // namespace sandhopper
