#include <gpiod.h>

#include "drivers/gpio/gpio_chip.hpp"

namespace sandhopper {

namespace {

// Calls the library's function that frees a T.
template <auto free_it>
struct Free {
  void operator()(auto* object) const noexcept { free_it(object); }
};
template <class T, auto free_it>
using Owned = std::unique_ptr<T, Free<free_it>>;

using Settings = Owned<gpiod_line_settings, ::gpiod_line_settings_free>;
using Lines = Owned<gpiod_line_config, ::gpiod_line_config_free>;
using RequestConfig = Owned<gpiod_request_config, ::gpiod_request_config_free>;
using Request = Owned<gpiod_line_request, ::gpiod_line_request_release>;
using EventBuffer = Owned<gpiod_edge_event_buffer, ::gpiod_edge_event_buffer_free>;
using ChipInfo = Owned<gpiod_chip_info, ::gpiod_chip_info_free>;
using LineInfo = Owned<gpiod_line_info, ::gpiod_line_info_free>;

gpiod_line_bias bias_of(const LineConfig& config) {
  switch (config.bias) {
    case Bias::as_is:
      break;
    case Bias::none:
      return GPIOD_LINE_BIAS_DISABLED;
    case Bias::pull_up:
      return GPIOD_LINE_BIAS_PULL_UP;
    case Bias::pull_down:
      return GPIOD_LINE_BIAS_PULL_DOWN;
  }
  return GPIOD_LINE_BIAS_AS_IS;
}

// The kernel applies active-low to both levels and edges.
bool describe(gpiod_line_settings* settings, const LineConfig& config, LineUse use) {
  const bool output = use == LineUse::output_inactive || use == LineUse::output_active;
  ::gpiod_line_settings_set_active_low(settings, config.active_low);
  return ::gpiod_line_settings_set_direction(
             settings, output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT) == 0 &&
         ::gpiod_line_settings_set_bias(settings, bias_of(config)) == 0 &&
         ::gpiod_line_settings_set_edge_detection(
             settings, use == LineUse::rising_edges ? GPIOD_LINE_EDGE_RISING : GPIOD_LINE_EDGE_NONE) == 0 &&
         ::gpiod_line_settings_set_event_clock(settings, GPIOD_LINE_CLOCK_MONOTONIC) == 0 &&
         ::gpiod_line_settings_set_output_value(
             settings, use == LineUse::output_active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) ==
             0;
}

class Line2 : public GpioLine {
 public:
  Line2(Request request, unsigned number, EventBuffer events)
      : request_(std::move(request)), number_(number), events_(std::move(events)) {}

  int value() noexcept override { return ::gpiod_line_request_get_value(request_.get(), number_); }

  bool set(bool active) noexcept override {
    return ::gpiod_line_request_set_value(request_.get(), number_,
                                          active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE) == 0;
  }

  int take_edges(std::int64_t timeout_ns, std::int64_t& newest_ns) noexcept override {
    if (const int ready = ::gpiod_line_request_wait_edge_events(request_.get(), timeout_ns); ready <= 0)
      return ready;
    const int count = ::gpiod_line_request_read_edge_events(request_.get(), events_.get(), kEdgeCapacity);
    if (count > 0) {
      auto* newest =
          ::gpiod_edge_event_buffer_get_event(events_.get(), static_cast<unsigned long>(count) - 1);
      newest_ns = static_cast<std::int64_t>(::gpiod_edge_event_get_timestamp_ns(newest));
    }
    return count;
  }

 private:
  Request request_;
  unsigned number_;
  EventBuffer events_;  // allocated with the line, used by every read
};

class Chip2 : public GpioChip {
 public:
  explicit Chip2(gpiod_chip* chip) : chip_(chip) {}

  std::string label() override {
    const ChipInfo info(::gpiod_chip_get_info(chip_.get()));
    return info ? ::gpiod_chip_info_get_label(info.get()) : "";
  }

  unsigned line_count() override {
    const ChipInfo info(::gpiod_chip_get_info(chip_.get()));
    return info ? static_cast<unsigned>(::gpiod_chip_info_get_num_lines(info.get())) : 0;
  }

  std::optional<unsigned> line_named(const std::string& name) override {
    const int number = ::gpiod_chip_get_line_offset_from_name(chip_.get(), name.c_str());
    if (number < 0) return std::nullopt;
    return static_cast<unsigned>(number);
  }

  std::string user_of(unsigned number) override {
    const LineInfo info(::gpiod_chip_get_line_info(chip_.get(), number));
    if (!info || !::gpiod_line_info_is_used(info.get())) return "";
    const char* user = ::gpiod_line_info_get_consumer(info.get());
    return user == nullptr || *user == '\0' ? "the kernel" : user;
  }

  std::unique_ptr<GpioLine> request(unsigned number, const LineConfig& config, LineUse use) override {
    const Settings settings(::gpiod_line_settings_new());
    const Lines lines(::gpiod_line_config_new());
    const RequestConfig how(::gpiod_request_config_new());
    EventBuffer events(::gpiod_edge_event_buffer_new(kEdgeCapacity));
    if (!settings || !lines || !how || !events || !describe(settings.get(), config, use) ||
        ::gpiod_line_config_add_line_settings(lines.get(), &number, 1, settings.get()) != 0)
      return nullptr;
    ::gpiod_request_config_set_consumer(how.get(), kConsumer);
    ::gpiod_request_config_set_event_buffer_size(how.get(), kEdgeCapacity);
    Request request(::gpiod_chip_request_lines(chip_.get(), how.get(), lines.get()));
    if (!request) return nullptr;
    return std::make_unique<Line2>(std::move(request), number, std::move(events));
  }

 private:
  Owned<gpiod_chip, ::gpiod_chip_close> chip_;
};

}  // namespace

std::unique_ptr<GpioChip> GpioChip::open(const std::string& path) {
  auto* chip = ::gpiod_chip_open(path.c_str());
  return chip == nullptr ? nullptr : std::make_unique<Chip2>(chip);
}

}  // namespace sandhopper
