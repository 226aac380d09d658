#include "drivers/gpio/gpio.hpp"

#include <gpiod.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <utility>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

// The C library: its C++ layer allocates for every level it reads, and the e-stop is read in the cycle.
namespace sandhopper {

struct CloseChip {
  void operator()(gpiod_line* line) const noexcept { ::gpiod_line_close_chip(line); }
};
using FoundLine = std::unique_ptr<gpiod_line, CloseChip>;

namespace {

constexpr const char* kConsumer = "sandhopper";

std::string describe(std::string_view role, const LineConfig& config) {
  return std::string(role) + " (GPIO line \"" + config.line + "\" of chip \"" +
         (config.chip.empty() ? "any" : config.chip) + "\")";
}

bool is_number(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

int flags_of(const LineConfig& config) {
  int flags = config.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (config.bias == Bias::none) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
  if (config.bias == Bias::pull_up) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (config.bias == Bias::pull_down) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  return flags;
}

timespec duration(std::int64_t ns) { return {ns / kNanosecondsPerSecond, ns % kNanosecondsPerSecond}; }

FoundLine find(const std::string& device, const LineConfig& config) {
  const auto& name = config.line;
  if (name.empty() || (config.chip.empty() && is_number(name)))
    throw DeviceError(device, "no line is named", "Give chip and line as gpiodetect and gpioinfo list them");
  if (config.chip.empty()) {
    if (auto* line = ::gpiod_line_find(name.c_str())) return FoundLine(line);
  } else {
    auto* chip = ::gpiod_chip_open_lookup(config.chip.c_str());
    if (chip == nullptr)
      throw DeviceError(
          device, errno_cause("cannot open the chip"),
          "gpiodetect lists the chips; access needs root or the group that owns /dev/gpiochip*");
    auto* line = is_number(name) ? ::gpiod_chip_get_line(chip, static_cast<unsigned>(std::stoul(name)))
                                 : ::gpiod_chip_find_line(chip, name.c_str());
    if (line != nullptr) return FoundLine(line);
    ::gpiod_chip_close(chip);
  }
  throw DeviceError(device, "there is no such line", "gpioinfo lists the lines of every chip");
}

}  // namespace

// One requested line and its chip, closed together.
class GpioLine {
 public:
  // `take` requests the found line with the given flags; below 0: refused.
  template <class Take>
  GpioLine(std::string_view role, const LineConfig& config, Take&& take) {
    const auto device = describe(role, config);
    line_ = find(device, config);
    if (take(line_.get(), flags_of(config)) < 0)
      throw DeviceError(
          device, errno_cause("cannot take the line"),
          "gpioinfo shows who uses it; a bias the chip cannot do is refused too: set bias = \"as_is\"");
  }

  gpiod_line* get() const noexcept { return line_.get(); }

 private:
  FoundLine line_;
};

GpioInput::GpioInput(std::string_view role, const LineConfig& config)
    : line_(std::make_unique<GpioLine>(role, config, [](gpiod_line* line, int flags) {
        return ::gpiod_line_request_input_flags(line, kConsumer, flags);
      })) {}
GpioInput::~GpioInput() = default;
GpioInput::GpioInput(GpioInput&&) noexcept = default;

// 0 is the only answer that means "not active": -1 is a line that cannot be read.
bool GpioEdges::active() noexcept { return ::gpiod_line_get_value(line_->get()) != 0; }

bool GpioInput::active() noexcept { return ::gpiod_line_get_value(line_->get()) != 0; }

GpioOutput::GpioOutput(std::string_view role, const LineConfig& config, bool initially_active)
    : line_(std::make_unique<GpioLine>(role, config,
                                       [&](gpiod_line* line, int flags) {
                                         return ::gpiod_line_request_output_flags(line, kConsumer, flags,
                                                                                  initially_active ? 1 : 0);
                                       })),
      active_(initially_active) {}
GpioOutput::~GpioOutput() = default;
GpioOutput::GpioOutput(GpioOutput&&) noexcept = default;

bool GpioOutput::set(bool active) noexcept {
  if (active == active_) return true;
  if (::gpiod_line_set_value(line_->get(), active ? 1 : 0) != 0) return false;
  active_ = active;
  return true;
}

// Active-low is applied by the kernel to edges too: rising is from inactive to active.
GpioEdges::GpioEdges(std::string_view role, const LineConfig& config)
    : line_(std::make_unique<GpioLine>(role, config, [](gpiod_line* line, int flags) {
        return ::gpiod_line_request_rising_edge_events_flags(line, kConsumer, flags);
      })) {}
GpioEdges::~GpioEdges() = default;
GpioEdges::GpioEdges(GpioEdges&&) noexcept = default;

std::optional<GpioEdges::Edge> GpioEdges::wait(std::int64_t timeout_ns) noexcept {
  std::optional<Edge> newest;
  std::array<gpiod_line_event, 16> events{};
  for (auto timeout = duration(timeout_ns);; timeout = duration(0)) {
    const int ready = ::gpiod_line_event_wait(line_->get(), &timeout);
    if (ready == 0) return newest;
    const int count =
        ready < 0 ? ready : ::gpiod_line_event_read_multiple(line_->get(), events.data(), events.size());
    if (count <= 0) {
      sleep_ns(timeout_ns);  // a line that has gone must not make its reader spin
      return newest;
    }
    const auto before = newest ? newest->count : 0;
    newest = Edge{to_ns(events[static_cast<std::size_t>(count) - 1].ts),
                  before + static_cast<std::uint32_t>(count)};
  }
}

std::string user_of_gpio_line(std::string_view role, const LineConfig& config) {
  const auto line = find(describe(role, config), config);
  if (!::gpiod_line_is_used(line.get())) return "";
  const char* user = ::gpiod_line_consumer(line.get());
  return user == nullptr || *user == '\0' ? "the kernel" : user;
}

}  // namespace sandhopper
