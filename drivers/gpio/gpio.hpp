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

// A level to be read each cycle, such as the e-stop. `active_low` with a normally closed switch and a pull
// towards ground: a cut wire reads active, and so does a line that cannot be read any more.
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
  // Writes only a change; false when it could not.
  bool set(bool active) noexcept;

 private:
  std::unique_ptr<GpioLine> line_;
  bool active_;
};

// Edges of a data-ready line with the kernel's CLOCK_MONOTONIC time of the interrupt.
class GpioEdges {
 public:
  struct Edge {
    std::int64_t time_ns;  // of the newest
    std::uint32_t count;   // waiting edges that were taken with it
  };

  // Edges from inactive to active.
  GpioEdges(std::string_view role, const LineConfig& config);
  ~GpioEdges();
  GpioEdges(GpioEdges&&) noexcept;

  // Waits for an edge, then empties the queue. The kernel keeps 16; of more it drops the newest with
  // libgpiod 1.x and the oldest with 2.x.
  std::optional<Edge> wait(std::int64_t timeout_ns) noexcept;

  // The level now; true when it cannot be read.
  bool active() noexcept;

 private:
  std::unique_ptr<GpioLine> line_;
};

// Who holds the line, empty when nobody does. Looks without taking it or changing its direction.
std::string user_of_gpio_line(std::string_view role, const LineConfig& config);

}  // namespace sandhopper
