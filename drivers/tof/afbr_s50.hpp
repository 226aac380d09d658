#pragma once
#include <optional>

#include "drivers/device_counters.hpp"
#include "drivers/samples.hpp"
#include "drivers/serial/serial_port.hpp"
#include "drivers/tof/companion_clock.hpp"
#include "drivers/tof/sci_protocol.hpp"
#include "drivers/tof/tof_config.hpp"

namespace sandhopper {

// Height. A status other than 0, a negative range or one outside the configured limits gives no measurement.
TofSample to_sample(const SciMeasurement& measurement, const TofConfig& config,
                    std::int64_t time_ns) noexcept;

// The sensor behind its companion controller on a serial line; it needs a thread of its own. The constructor
// runs the start-up sequence (stop, ping, 1-D output, modes, frame time, start), each acknowledged by the
// controller. Throws DeviceError.
class AfbrS50 {
 public:
  explicit AfbrS50(const TofConfig& config);
  ~AfbrS50();

  // Waits at most 50 ms for bytes. True if they completed a measurement; `sample` is then the newest one.
  bool acquire(TofSample& sample) noexcept;

  const DeviceCounters& counters() const noexcept { return counters_; }

 private:
  void request(SciCommand command, std::span<const std::uint8_t> payload = {});
  std::optional<SciAnswer> await_answer(SciCommand command);
  std::int64_t stamp(const SciMeasurement& measurement, std::int64_t arrival_ns) noexcept;

  TofConfig config_;
  SerialPort port_;
  SciParser parser_;
  CompanionClock clock_;
  DeviceCounters counters_;
};

}  // namespace sandhopper
