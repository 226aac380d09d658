#pragma once
#include "drivers/samples.hpp"
#include "firmware/controller_config.hpp"

namespace sandhopper {

// True if the leg hits its end stop: the force on the body is then larger than any spring's. In that case the
// load cell truly exceeds its range. It also reads more than the momentum observer, which does not model the
// stops.
inline bool strikes_end_stop(const ImuSample& body, const CycleConfig& config) noexcept {
  constexpr double kShare = 0.5;  // of load_cell_range_N
  return config.robot.body_mass_kg * body.accel_mps2[2] > kShare * config.supervision.load_cell_range_N;
}

}  // namespace sandhopper
