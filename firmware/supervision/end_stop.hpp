#pragma once
#include "drivers/samples.hpp"
#include "firmware/controller_config.hpp"

namespace sandhopper {

// The leg strikes its end stop: the body feels a force that no spring makes. The load cell then reads more
// than its range allows, truly, and more than the momentum observer, which knows nothing of stops.
inline bool strikes_end_stop(const ImuSample& body, const CycleConfig& config) noexcept {
  constexpr double kShare = 0.5;  // of load_cell_range_N
  return config.robot.body_mass_kg * body.accel_mps2[2] > kShare * config.supervision.load_cell_range_N;
}

}  // namespace sandhopper
