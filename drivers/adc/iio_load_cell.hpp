#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include "drivers/device_counters.hpp"
#include "drivers/samples.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {

// A load cell on a converter that the kernel drives as an IIO device. The HX711 (10 or 80 values a second)
// and the NAU7802 (10 to 320) connect directly to the bridge. Force = sign scale (voltage - zero).
struct IioLoadCellConfig {
  std::string device = "/sys/bus/iio/devices/iio:device0";
  int channel = 0;
  double scale_N_per_V = 1.0e5;  // bridges give a few millivolts
  double zero_V = 0.0;
  int sign = 1;
  double latency_s = 0.05;  // from the middle of a conversion until its value was read

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("device", self.device);
    visit("channel", self.channel, Range{0, 15});
    visit("scale_N_per_V", self.scale_N_per_V, Range{1e-3, 1e9});
    visit("zero_V", self.zero_V, Range{-10.0, 10.0});
    visit("sign", self.sign, Range{-1, 1});
    visit("latency_s", self.latency_s, Range{0, 0.2});
  }

  template <class Problem>
  void check(Problem&& problem) const {
    if (sign == 0) problem("sign", "must be 1 or -1");
  }
};

// Reads in_voltageN_raw, which waits for a conversion, and in_voltageN_scale (or in_voltage_scale), in mV
// (Documentation/ABI/testing/sysfs-bus-iio). For a thread of its own.
class IioLoadCell {
 public:
  // Throws DeviceError if the device or channel does not exist or cannot be read.
  explicit IioLoadCell(const IioLoadCellConfig& config);

  // Waits for the next conversion. Returns false after a pause of 10 ms if it cannot be read.
  bool acquire(LoadCellSample& sample) noexcept;

  const DeviceCounters& counters() const noexcept { return counters_; }
  const std::string& chip() const noexcept { return chip_; }  // "hx711"

 private:
  bool read_raw(long& raw) noexcept;

  IioLoadCellConfig config_;
  std::string chip_;
  double volts_per_count_ = 0.0;
  UniqueFd raw_;
  std::uint32_t samples_ = 0;
  DeviceCounters counters_;
};

}  // namespace sandhopper
