#pragma once
#include <memory>

#include "drivers/adc/load_cell_config.hpp"
#include "drivers/device_counters.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

// The load cell behind whichever converter it has, for a thread of its own.
class LoadCellSource {
 public:
  virtual ~LoadCellSource() = default;

  // Waits for the next conversion. False where none came or it cannot be read.
  virtual bool acquire(LoadCellSample& sample) noexcept = 0;
  virtual const DeviceCounters& counters() const noexcept = 0;
};

// Opens and starts the converter that the configuration names. Throws DeviceError.
std::unique_ptr<LoadCellSource> open_load_cell(const LoadCellConfig& config);

}  // namespace sandhopper
