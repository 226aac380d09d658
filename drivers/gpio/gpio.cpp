#include "drivers/gpio/gpio.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <string>
#include <vector>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"
#include "drivers/gpio/gpio_chip.hpp"

namespace sandhopper {

namespace {

namespace fs = std::filesystem;

std::string describe(std::string_view role, const LineConfig& config) {
  return std::string(role) + " (GPIO line \"" + config.line + "\" of chip \"" +
         (config.chip.empty() ? "any" : config.chip) + "\")";
}

std::optional<unsigned> as_number(const std::string& text) {
  unsigned number = 0;
  const auto* const end = text.data() + text.size();
  const auto [parsed_to, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || parsed_to != end) return std::nullopt;
  return number;
}

DeviceError cannot_open(const std::string& device) {
  return {device, errno_cause("cannot open the chip"),
          "gpiodetect lists the chips; access needs root or the group that owns /dev/gpiochip*"};
}

// Sorted, so that of two chips with a line of the same name always the same one is found. Symbolic links are
// skipped.
std::vector<std::string> chip_paths() {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev", ignored))
    if (entry.path().filename().string().starts_with("gpiochip") && !entry.is_symlink(ignored))
      paths.push_back(entry.path().string());
  std::ranges::sort(paths);
  return paths;
}

struct FoundLine {
  std::unique_ptr<GpioChip> chip;
  unsigned number;
};

// First chip for which `fits` is true. Null if there is none: then errno is 0, or the reason why a chip
// could not be opened.
template <class Fits>
std::unique_ptr<GpioChip> find_chip(Fits&& fits) {
  int error = 0;
  for (const auto& path : chip_paths()) {
    auto chip = GpioChip::open(path);
    if (chip == nullptr)
      error = errno;
    else if (fits(*chip))
      return chip;
  }
  errno = error;
  return nullptr;
}

// `name` is a number, a path, a label or a device name. A label takes precedence over a device name, as in
// libgpiod 1.6.
std::unique_ptr<GpioChip> open_chip(const std::string& name) {
  if (const auto number = as_number(name)) return GpioChip::open("/dev/gpiochip" + std::to_string(*number));
  if (name.starts_with('/')) return GpioChip::open(name);
  auto chip = find_chip([&](GpioChip& candidate) { return candidate.label() == name; });
  if (chip != nullptr) return chip;
  const int unreadable = errno;
  chip = GpioChip::open("/dev/" + name);
  if (chip == nullptr && unreadable != 0)
    errno = unreadable;  // the chip that could not be opened may have
                         // this label
  return chip;
}

FoundLine find(const std::string& device, const LineConfig& config) {
  const auto& name = config.line;
  const auto number = as_number(name);
  if (name.empty() || (config.chip.empty() && number))
    throw DeviceError(device, "no line is named", "Give chip and line as gpiodetect and gpioinfo list them");
  if (config.chip.empty()) {
    std::optional<unsigned> found;
    auto chip = find_chip([&](GpioChip& candidate) {
      found = candidate.line_named(name);
      return found.has_value();
    });
    if (chip != nullptr) return {std::move(chip), *found};
    if (errno != 0) throw cannot_open(device);
  } else {
    auto chip = open_chip(config.chip);
    if (chip == nullptr) throw cannot_open(device);
    const auto found = number ? number : chip->line_named(name);
    if (found && *found < chip->line_count()) return {std::move(chip), *found};
  }
  throw DeviceError(device, "there is no such line", "gpioinfo lists the lines of every chip");
}

std::unique_ptr<GpioLine> take(std::string_view role, const LineConfig& config, LineUse use) {
  const auto device = describe(role, config);
  const auto found = find(device, config);
  auto line = found.chip->request(found.number, config, use);
  if (line == nullptr)
    throw DeviceError(
        device, errno_cause("cannot take the line"),
        "gpioinfo shows who uses it; a bias the chip cannot do is refused too: set bias = \"as_is\"");
  return line;
}

}  // namespace

GpioInput::GpioInput(std::string_view role, const LineConfig& config)
    : line_(take(role, config, LineUse::input)) {}
GpioInput::~GpioInput() = default;
GpioInput::GpioInput(GpioInput&&) noexcept = default;

// Only 0 means "not active". -1 (cannot be read) counts as active.
bool GpioInput::active() noexcept { return line_->value() != 0; }

bool GpioEdges::active() noexcept { return line_->value() != 0; }

GpioOutput::GpioOutput(std::string_view role, const LineConfig& config, bool initially_active)
    : line_(take(role, config, initially_active ? LineUse::output_active : LineUse::output_inactive)),
      active_(initially_active) {}
GpioOutput::~GpioOutput() = default;
GpioOutput::GpioOutput(GpioOutput&&) noexcept = default;

bool GpioOutput::set(bool active) noexcept {
  if (active == active_) return true;
  if (!line_->set(active)) return false;
  active_ = active;
  return true;
}

GpioEdges::GpioEdges(std::string_view role, const LineConfig& config)
    : line_(take(role, config, LineUse::rising_edges)) {}
GpioEdges::~GpioEdges() = default;
GpioEdges::GpioEdges(GpioEdges&&) noexcept = default;

std::optional<GpioEdges::Edge> GpioEdges::wait(std::int64_t timeout_ns) noexcept {
  std::optional<Edge> newest;
  for (auto timeout = timeout_ns;; timeout = 0) {
    std::int64_t time_ns = 0;
    const int count = line_->take_edges(timeout, time_ns);
    if (count == 0) return newest;
    if (count < 0) {
      sleep_ns(timeout_ns);  // if the line has failed, sleep so that the reader does not spin
      return newest;
    }
    newest = Edge{time_ns, (newest ? newest->count : 0) + static_cast<std::uint32_t>(count)};
  }
}

std::string user_of_gpio_line(std::string_view role, const LineConfig& config) {
  const auto found = find(describe(role, config), config);
  return found.chip->user_of(found.number);
}

}  // namespace sandhopper
