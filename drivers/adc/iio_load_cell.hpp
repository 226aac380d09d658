#pragma once
#include <cstdint>
#include <string>

#include "drivers/adc/load_cell_source.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {

// A load cell on a converter that the kernel drives as an IIO device, HX711 or NAU7802, which sit directly on
// the bridge. Force = sign scale (voltage - zero).
//
// Reads in_voltageN_raw, which waits for a conversion, and in_voltageN_scale (or in_voltage_scale), in mV
// (Documentation/ABI/testing/sysfs-bus-iio). For a thread of its own.
class IioLoadCell : public LoadCellSource {
 public:
  // Of `config` the keys of [load_cell.iio], scale, zero, sign and latency. Throws DeviceError: no such
  // device, no such channel, not to be read.
  explicit IioLoadCell(const LoadCellConfig& config);

  // The next conversion. False, after a pause of 10 ms, where it cannot be read.
  bool acquire(LoadCellSample& sample) noexcept override;

  const DeviceCounters& counters() const noexcept override { return counters_; }
  const std::string& chip() const noexcept { return chip_; }  // "hx711"

 private:
  bool read_raw(long& raw) noexcept;

  LoadCellConfig config_;
  std::string chip_;
  double volts_per_count_ = 0.0;
  UniqueFd raw_;
  std::uint32_t samples_ = 0;
  DeviceCounters counters_;
};

}  // namespace sandhopper
