#pragma once
#include <string>

#include "drivers/adc/ads1115.hpp"
#include "drivers/device_counters.hpp"
#include "drivers/gpio/gpio.hpp"
#include "drivers/i2c/i2c_device.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

// The load cell on its device nodes, for a thread of its own. Opens and starts the converter; throws
// DeviceError.
class LoadCellReader {
 public:
  explicit LoadCellReader(const LoadCellConfig& config);

  // Waits for the next conversion: 50 ms, or two conversions at the slowest rates. Its time is the ready edge
  // minus `latency_s`.
  bool acquire(LoadCellSample& sample) noexcept;

  const DeviceCounters& counters() const noexcept { return counters_; }

 private:
  LoadCellConfig config_;
  I2cDevice bus_;
  Ads1115 converter_;
  GpioEdges edges_;
  std::uint32_t samples_ = 0;
  DeviceCounters counters_;
};

}  // namespace sandhopper
