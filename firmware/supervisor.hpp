#pragma once
#include <array>
#include <cstdint>

#include "firmware/controller_config.hpp"
#include "firmware/event.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

struct FaultFound {
  Fault fault = Fault::none;
  std::array<double, 2> values{};  // what was seen and what was allowed
};

// Looks at every frame and says which limit it breaks, if any. Called only while drives are on.
class Supervisor {
 public:
  explicit Supervisor(const CycleConfig& config) noexcept : config_(config) {}
  void begin(const SensorFrame& frame) noexcept;
  FaultFound check(const SensorFrame& frame, const Estimate& estimate, double phase_time_s) noexcept;

 private:
  FaultFound check_motors(const SensorFrame& frame) noexcept;
  FaultFound check_ages(const SensorFrame& frame) const noexcept;

  const CycleConfig& config_;
  std::array<int, kMotorCount> misses_{};
  std::uint32_t bus_faults_ = 0;
};

}  // namespace sandhopper
