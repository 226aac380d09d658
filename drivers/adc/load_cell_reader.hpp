#pragma once
#include <string>

#include "drivers/adc/ads1115.hpp"
#include "drivers/adc/load_cell_source.hpp"
#include "drivers/gpio/gpio.hpp"
#include "drivers/i2c/i2c_device.hpp"

namespace sandhopper {

// The load cell on an ADS1115. Opens and starts the converter; throws
// DeviceError.
class LoadCellReader : public LoadCellSource {
 public:
  explicit LoadCellReader(const LoadCellConfig& config);

  // Waits (50 ms; at the slowest rates two conversions) for the next conversion. Stamp: its ready edge less
  // `latency_s`.
  bool acquire(LoadCellSample& sample) noexcept override;

  const DeviceCounters& counters() const noexcept override { return counters_; }

 private:
  LoadCellConfig config_;
  I2cDevice bus_;
  Ads1115 converter_;
  GpioEdges edges_;
  std::uint32_t samples_ = 0;
  DeviceCounters counters_;
};

}  // namespace sandhopper
