#include "drivers/gpio/gpio.hpp"

#include <algorithm>
#include <chrono>
#include <gpiod.hpp>
#include <string>
#include <system_error>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {

namespace {

std::string describe(std::string_view role, const LineConfig& config) {
  return std::string(role) + " (GPIO line \"" + config.line + "\" of chip \"" +
         (config.chip.empty() ? "any" : config.chip) + "\")";
}

gpiod::line find(const std::string& device, const LineConfig& config) {
  const auto& name = config.line;
  const bool is_number =
      !name.empty() && std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
  if (name.empty() || (config.chip.empty() && is_number))
    throw DeviceError(device, "no line is named", "Give chip and line as gpiodetect and gpioinfo list them");
  try {
    auto line = config.chip.empty() ? gpiod::find_line(name)
                : is_number ? gpiod::chip(config.chip).get_line(static_cast<unsigned>(std::stoul(name)))
                            : gpiod::chip(config.chip).find_line(name);
    if (line) return line;
  } catch (const std::exception& error) {
    throw DeviceError(device, error.what(),
                      "gpiodetect lists the chips, gpioinfo their lines; access needs root or "
                      "the group that owns /dev/gpiochip*");
  }
  throw DeviceError(device, "there is no such line", "gpioinfo lists the lines of every chip");
}

gpiod::line_request request_of(const LineConfig& config, int type) {
  gpiod::line_request request{"sandhopper", type, {}};
  if (config.active_low) request.flags |= gpiod::line_request::FLAG_ACTIVE_LOW;
  if (config.bias == Bias::none) request.flags |= gpiod::line_request::FLAG_BIAS_DISABLE;
  if (config.bias == Bias::pull_up) request.flags |= gpiod::line_request::FLAG_BIAS_PULL_UP;
  if (config.bias == Bias::pull_down) request.flags |= gpiod::line_request::FLAG_BIAS_PULL_DOWN;
  return request;
}

}  // namespace

class GpioLine {
 public:
  GpioLine(std::string_view role, const LineConfig& config, int type, int initial = 0) {
    const auto device = describe(role, config);
    line = find(device, config);
    try {
      line.request(request_of(config, type), initial);
    } catch (const std::exception& error) {
      throw DeviceError(
          device, std::string("cannot take the line: ") + error.what(),
          "gpioinfo shows who uses it; a bias the chip cannot do is refused too: set bias = \"as_is\"");
    }
  }

  gpiod::line line;
};

GpioInput::GpioInput(std::string_view role, const LineConfig& config)
    : line_(std::make_unique<GpioLine>(role, config, gpiod::line_request::DIRECTION_INPUT)) {}
GpioInput::~GpioInput() = default;
GpioInput::GpioInput(GpioInput&&) noexcept = default;

bool GpioInput::active() noexcept {
  if (failed_) return true;
  try {
    return line_->line.get_value() != 0;
  } catch (...) {
    failed_ = true;
    return true;
  }
}

GpioOutput::GpioOutput(std::string_view role, const LineConfig& config, bool initially_active)
    : line_(std::make_unique<GpioLine>(role, config, gpiod::line_request::DIRECTION_OUTPUT,
                                       initially_active ? 1 : 0)),
      active_(initially_active) {}
GpioOutput::~GpioOutput() = default;
GpioOutput::GpioOutput(GpioOutput&&) noexcept = default;

bool GpioOutput::set(bool active) noexcept {
  if (active == active_) return true;
  try {
    line_->line.set_value(active ? 1 : 0);
    active_ = active;
    return true;
  } catch (...) {
    return false;
  }
}

// Active-low is applied by the kernel to edges too: rising is from inactive to active.
GpioEdges::GpioEdges(std::string_view role, const LineConfig& config)
    : line_(std::make_unique<GpioLine>(role, config, gpiod::line_request::EVENT_RISING_EDGE)) {}
GpioEdges::~GpioEdges() = default;
GpioEdges::GpioEdges(GpioEdges&&) noexcept = default;

std::optional<GpioEdges::Edge> GpioEdges::wait(std::int64_t timeout_ns) noexcept {
  try {
    std::optional<Edge> newest;
    std::chrono::nanoseconds timeout(timeout_ns);
    while (line_->line.event_wait(timeout)) {
      const auto event = line_->line.event_read();
      newest = Edge{event.timestamp.count(), newest ? newest->count + 1 : 1};
      timeout = std::chrono::nanoseconds::zero();
    }
    return newest;
  } catch (...) {
    sleep_ns(timeout_ns);  // a line that has gone must not make its reader spin
    return std::nullopt;
  }
}

std::string user_of_gpio_line(std::string_view role, const LineConfig& config) {
  const auto line = find(describe(role, config), config);
  if (!line.is_used()) return "";
  const auto user = line.consumer();
  return user.empty() ? "the kernel" : user;
}

}  // namespace sandhopper
