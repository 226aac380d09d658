#include <gpiod.h>

#include <array>

#include "drivers/clock.hpp"
#include "drivers/gpio/gpio_chip.hpp"

namespace sandhopper {

namespace {

int flags_of(const LineConfig& config) {
  int flags = config.active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
  if (config.bias == Bias::none) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_DISABLE;
  if (config.bias == Bias::pull_up) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP;
  if (config.bias == Bias::pull_down) flags |= GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_DOWN;
  return flags;
}

timespec duration(std::int64_t ns) { return {ns / kNanosecondsPerSecond, ns % kNanosecondsPerSecond}; }

int request_line(gpiod_line* line, int flags, LineUse use) {
  switch (use) {
    case LineUse::input:
      return ::gpiod_line_request_input_flags(line, kConsumer, flags);
    case LineUse::output_inactive:
      return ::gpiod_line_request_output_flags(line, kConsumer, flags, 0);
    case LineUse::output_active:
      return ::gpiod_line_request_output_flags(line, kConsumer, flags, 1);
    case LineUse::rising_edges:
      break;
  }
  return ::gpiod_line_request_rising_edge_events_flags(line, kConsumer, flags);
}

class Line1 : public GpioLine {
 public:
  // Closing the chip releases its lines, so the line keeps the chip open.
  Line1(std::shared_ptr<gpiod_chip> chip, gpiod_line* line) : chip_(std::move(chip)), line_(line) {}

  int value() noexcept override { return ::gpiod_line_get_value(line_); }

  bool set(bool active) noexcept override { return ::gpiod_line_set_value(line_, active ? 1 : 0) == 0; }

  int take_edges(std::int64_t timeout_ns, std::int64_t& newest_ns) noexcept override {
    const auto timeout = duration(timeout_ns);
    if (const int ready = ::gpiod_line_event_wait(line_, &timeout); ready <= 0) return ready;
    std::array<gpiod_line_event, kEdgeCapacity> events;
    const int count = ::gpiod_line_event_read_multiple(line_, events.data(), events.size());
    if (count > 0) newest_ns = to_ns(events[static_cast<std::size_t>(count) - 1].ts);
    return count;
  }

 private:
  std::shared_ptr<gpiod_chip> chip_;
  gpiod_line* line_;
};

class Chip1 : public GpioChip {
 public:
  explicit Chip1(gpiod_chip* chip) : chip_(chip, ::gpiod_chip_close) {}

  std::string label() override { return ::gpiod_chip_label(chip_.get()); }

  unsigned line_count() override { return ::gpiod_chip_num_lines(chip_.get()); }

  std::optional<unsigned> line_named(const std::string& name) override {
    auto* line = ::gpiod_chip_find_line(chip_.get(), name.c_str());
    if (line == nullptr) return std::nullopt;
    return ::gpiod_line_offset(line);
  }

  std::string user_of(unsigned number) override {
    auto* line = ::gpiod_chip_get_line(chip_.get(), number);
    if (line == nullptr || !::gpiod_line_is_used(line)) return "";
    const char* user = ::gpiod_line_consumer(line);
    return user == nullptr || *user == '\0' ? "the kernel" : user;
  }

  std::unique_ptr<GpioLine> request(unsigned number, const LineConfig& config, LineUse use) override {
    auto* line = ::gpiod_chip_get_line(chip_.get(), number);
    if (line == nullptr || request_line(line, flags_of(config), use) < 0) return nullptr;
    return std::make_unique<Line1>(chip_, line);
  }

 private:
  std::shared_ptr<gpiod_chip> chip_;
};

}  // namespace

std::unique_ptr<GpioChip> GpioChip::open(const std::string& path) {
  auto* chip = ::gpiod_chip_open(path.c_str());
  return chip == nullptr ? nullptr : std::make_unique<Chip1>(chip);
}

}  // namespace sandhopper
