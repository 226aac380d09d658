#include "tools/conceal/bed/bed_effects.hpp"
#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/hopper/world.hpp"
#include "tools/conceal/plants.hpp"

namespace sandhopper::conceal {

const Plant& hopper_plant() {
  using namespace hopper;
  static const PlantOf<World> plant([] {
    auto listed = for_bed_of<World>(bed_speed_effects());
    append(listed, for_bed_of<World>(bed_depth_effects()));
    append(listed, for_bed_of<World>(bed_history_effects()));
    for (auto effects : {rail_effects(), joint_effects(), drive_effects(), mass_effects(), sensor_effects()})
      append(listed, std::move(effects));
    auto unlisted = for_bed_of<World>(bed_unlisted_effects());
    append(unlisted, unlisted_effects());
    return PlantSpec<World>{
        .name = "hopper",
        .draw = draw,
        .belief = belief,
        .draw_setups = draw_setups,
        .record = record,
        .phases = phases,
        .listed = std::move(listed),
        .unlisted = std::move(unlisted),
        .restrictions = restrictions(),
        .expendable = {"load_cell_force_N", "tof_height_m", "imu_foot_accel_z_mps2", "mocap_body_z_m"},
        .inputs = {"phase", "motor_left_temperature_C", "motor_right_temperature_C"}};
  }());
  return plant;
}

}  // namespace sandhopper::conceal
