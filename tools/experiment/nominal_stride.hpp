#pragma once
#include <vector>

#include "tools/plant/nominal_controller.hpp"
#include "tools/plant/world.hpp"

// First stride of the simulated robot under the nominal controller, without noise.
namespace sandhopper {

struct NominalStrideSetup {
  double release_height_m = 0.0618;
  double compression_stiffness_N_per_m = 375.0;
  int milliseconds = 500;
};

struct NominalRow {
  PlantTruth truth;           // at the start of the millisecond
  double mean_force_N = 0.0;  // over the millisecond
  NominalPhase phase = NominalPhase::flight;
};

struct NominalStride {
  std::vector<NominalRow> rows;
  std::vector<PlantTruth> grid;  // one row every 0.1 ms, starting with the first row
};

inline NominalStride nominal_stride(const NominalStrideSetup& setup, const WorldConfig& config = {}) {
  World world(config, {.release_height_m = setup.release_height_m, .noise = false}, 0);
  NominalController controller(config.controller, setup.compression_stiffness_N_per_m);
  world.open_catch();
  NominalStride stride;
  for (int ms = 0; ms < setup.milliseconds; ++ms) {
    NominalRow row{.truth = world.truth()};
    const double torque_Nm = controller.step(
        world.plant().leg(), {row.truth.foot_z_m, row.truth.leg_angle_rad, row.truth.leg_velocity_radps});
    row.phase = controller.phase();
    world.command(Side::left, {.torque_Nm = torque_Nm / 2}, true);
    world.command(Side::right, {.torque_Nm = torque_Nm / 2}, true);
    for (int i = 0; i < 10; ++i) {
      stride.grid.push_back(world.truth());
      world.advance_to(world.now_ns() + World::kStep_ns);
    }
    row.mean_force_N = (world.truth().contact_impulse_Ns - row.truth.contact_impulse_Ns) / 1e-3;
    stride.rows.push_back(row);
  }
  return stride;
}

}  // namespace sandhopper
