#include "drivers/adc/iio_load_cell.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "drivers/clock.hpp"
#include "drivers/device_error.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kRetry_ns = 10'000'000;
// A read that returns at once (device is a plain file) must not make the thread spin: wait this long.
constexpr std::int64_t kLeastRead_ns = 1'000'000;
constexpr double kVoltsPerMillivolt = 1e-3;

std::string word_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string word;
  in >> word;
  return word;
}

double scale_of(const IioConverterConfig& config, const std::string& role) {
  const std::filesystem::path device = config.device;
  auto text = word_in(device / ("in_voltage" + std::to_string(config.channel) + "_scale"));
  if (text.empty()) text = word_in(device / "in_voltage_scale");
  double scale = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), scale);
  if (error != std::errc{} || end != text.data() + text.size() || !(scale > 0.0))
    throw DeviceError(role, "in_voltage_scale reads \"" + text + "\"",
                      "Check that it is a voltage converter");
  return scale * kVoltsPerMillivolt;
}

}  // namespace

IioLoadCell::IioLoadCell(const LoadCellConfig& config) : config_(config) {
  const auto iio = config.iio.value_or(IioConverterConfig{});
  const std::string role = "load_cell (IIO " + iio.device + ")";
  const std::filesystem::path device = iio.device;
  chip_ = word_in(device / "name");
  if (chip_.empty())
    throw DeviceError(role, "is not there",
                      "Load its overlay and driver (hx711 or nau7802): cat /sys/bus/iio/devices/*/name");
  const auto raw = device / ("in_voltage" + std::to_string(iio.channel) + "_raw");
  raw_ = UniqueFd(::open(raw.c_str(), O_RDONLY | O_CLOEXEC));
  if (raw_.get() < 0)
    throw DeviceError(role, errno_cause("cannot open " + raw.string()),
                      "Name another channel, or run as root");
  volts_per_count_ = scale_of(iio, role);
}

bool IioLoadCell::read_raw(long& raw) noexcept {
  std::array<char, 32> text{};
  const auto length = ::pread(raw_.get(), text.data(), text.size(), 0);
  if (length <= 0) return false;
  return std::from_chars(text.data(), text.data() + length, raw).ec == std::errc{};
}

bool IioLoadCell::acquire(LoadCellSample& sample) noexcept {
  const auto begin_ns = monotonic_ns();
  long raw = 0;
  if (!read_raw(raw)) {
    ++counters_.failed_transfers;
    sleep_ns(kRetry_ns);
    return false;
  }
  const auto now_ns = monotonic_ns();
  if (now_ns - begin_ns < kLeastRead_ns) sleep_ns(kLeastRead_ns);
  const double voltage_V = static_cast<double>(raw) * volts_per_count_;
  sample = {now_ns - to_ns(config_.latency_s),
            config_.sign * config_.scale_N_per_V * (voltage_V - config_.zero_V), ++samples_, true};
  return true;
}

}  // namespace sandhopper
