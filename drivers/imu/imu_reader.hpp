#pragma once
#include <optional>
#include <string>

#include "drivers/device_counters.hpp"
#include "drivers/gpio/gpio.hpp"
#include "drivers/imu/ism330dhcx.hpp"
#include "drivers/spi/spi_device.hpp"

namespace sandhopper {

// An IMU on its device nodes, for a thread of its own. Opens and starts the sensor; throws DeviceError.
class ImuReader {
 public:
  ImuReader(const std::string& role, const ImuConfig& config);

  // Waits at most 20 ms for the next sample. Its time is that of the data-ready edge minus `latency_s`.
  // Without that line it is the time at which the status register showed the sample, minus `latency_s`.
  bool acquire(ImuSample& sample) noexcept;

  const DeviceCounters& counters() const noexcept { return counters_; }

 private:
  bool acquire_on_edge(ImuSample& sample) noexcept;
  bool acquire_by_polling(ImuSample& sample) noexcept;
  bool finish(ImuSample& sample, const ism330dhcx::Burst& burst, std::int64_t ready_ns,
              std::uint32_t new_samples) noexcept;
  bool read(ism330dhcx::Burst& burst) noexcept;

  ImuConfig config_;
  SpiDevice bus_;
  Ism330dhcx sensor_;
  std::optional<GpioEdges> edges_;
  std::uint32_t samples_ = 0;
  DeviceCounters counters_;
};

}  // namespace sandhopper
