#include "tools/virtual_bench/simulated_gpio.hpp"

#include <fcntl.h>
#include <linux/gpio.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace sandhopper::bench {
namespace {

namespace fs = std::filesystem;

const fs::path kDevice = "/sys/kernel/config/gpio-sim/bench";
constexpr int kFewestLines = 8;

std::string label_of(const LineConfig& config) {
  return config.chip.empty() || config.chip.front() == '/' ? "bench" : config.chip;
}

void write_file(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  if (!(file << text << std::flush))
    throw std::runtime_error(path.string() + " does not take '" + text + "': run this inside tools/bench");
}

std::string first_word(const fs::path& path) {
  std::string word;
  std::ifstream(path) >> word;
  return word;
}

UniqueFd open_file(const fs::path& path, int flags) {
  UniqueFd fd(::open(path.c_str(), flags | O_CLOEXEC));
  if (!fd) throw std::runtime_error(path.string() + " cannot be opened");
  return fd;
}

}  // namespace

void SimulatedLine::drive(bool high) {
  if (!driven_ || driven_high_ != high) {
    driven_ = true;
    driven_high_ = high;
    drive_again();
  }
}

void SimulatedLine::drive_again() {
  if (!pull_ || !driven_) return;
  const std::string_view pull = driven_high_ ? "pull-up" : "pull-down";
  if (::pwrite(pull_.get(), pull.data(), pull.size(), 0) < 0)
    throw std::runtime_error("a simulated GPIO line cannot be driven");
}

bool SimulatedLine::high() const {
  char level = '0';
  return value_ && ::pread(value_.get(), &level, 1, 0) == 1 && level == '1';
}

SimulatedGpio::SimulatedGpio(EventLoop& loop, const std::vector<LineConfig>& lines) : loop_(loop) {
  std::map<std::string, Offsets> chips;
  for (const auto& config : lines) {
    if (!config.fitted()) continue;
    auto& offsets = chips[label_of(config)];
    offsets[number_for(config, offsets)] = config.line;
  }
  fs::create_directory(kDevice);
  for (const auto& [label, offsets] : chips) {
    const auto bank = kDevice / label;
    fs::create_directory(bank);
    write_file(bank / "label", label);
    write_file(bank / "num_lines", std::to_string(std::max(kFewestLines, offsets.rbegin()->first + 1)));
    for (const auto& [number, name] : offsets) {
      const auto line = bank / ("line" + std::to_string(number));
      fs::create_directory(line);
      write_file(line / "name", name);
    }
  }
  write_file(kDevice / "live", "1");
  for (const auto& [label, offsets] : chips) open_chip(label, offsets);
}

SimulatedGpio::~SimulatedGpio() {
  for (const auto& [label, chip] : chips_) loop_.forget(chip.device.get());
}

// A line given as a number keeps it; one given by name takes the first that is free.
int SimulatedGpio::number_for(const LineConfig& config, const Offsets& taken) {
  int number = 0;
  const auto* const end = config.line.data() + config.line.size();
  if (std::from_chars(config.line.data(), end, number).ptr == end) return number;
  while (taken.contains(number)) ++number;
  return number;
}

void SimulatedGpio::open_chip(const std::string& label, const Offsets& offsets) {
  const auto chip_name = first_word(kDevice / label / "chip_name");
  const auto directory = fs::path("/sys/devices/platform") / first_word(kDevice / "dev_name") / chip_name;
  auto& chip = chips_[label];
  chip.device = open_file("/dev/" + chip_name, O_RDWR | O_NONBLOCK);
  for (const auto& [number, name] : offsets) {
    const auto line = directory / ("sim_gpio" + std::to_string(number));
    chip.lines[number] =
        SimulatedLine(open_file(line / "pull", O_WRONLY), open_file(line / "value", O_RDONLY));
    by_name_[{label, name}] = &chip.lines[number];
  }
  watch(chip);
}

void SimulatedGpio::watch(Chip& chip) {
  for (const auto& [number, line] : chip.lines) {
    gpio_v2_line_info info{};
    info.offset = static_cast<std::uint32_t>(number);
    if (::ioctl(chip.device.get(), GPIO_V2_GET_LINEINFO_WATCH_IOCTL, &info) != 0)
      throw std::runtime_error("a simulated GPIO line cannot be watched");
  }
  loop_.watch(chip.device.get(), [&chip] { drive_changed_lines(chip); });
}

void SimulatedGpio::drive_changed_lines(Chip& chip) {
  gpio_v2_line_info_changed changed{};
  while (::read(chip.device.get(), &changed, sizeof changed) == static_cast<ssize_t>(sizeof changed)) {
    const auto line = chip.lines.find(static_cast<int>(changed.info.offset));
    if (line != chip.lines.end()) line->second.drive_again();
  }
}

SimulatedLine& SimulatedGpio::line(const LineConfig& config) {
  return config.fitted() ? *by_name_.at({label_of(config), config.line}) : not_fitted_;
}

}  // namespace sandhopper::bench
