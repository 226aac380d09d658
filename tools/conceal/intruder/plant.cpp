#include "tools/conceal/bed/bed_effects.hpp"
#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/intruder/world.hpp"
#include "tools/conceal/plants.hpp"

namespace sandhopper::conceal {

const Plant& intruder_plant() {
  using namespace intruder;
  static const PlantOf<World> plant([] {
    auto listed = for_bed_of<World>(bed_speed_effects());
    append(listed, for_bed_of<World>(bed_depth_effects()));
    append(listed, for_bed_of<World>(bed_history_effects()));
    append(listed, rig_effects());
    return PlantSpec<World>{.name = "intruder",
                            .draw = draw,
                            .belief = belief,
                            .draw_setups = draw_setups,
                            .record = record,
                            .phases = phases,
                            .listed = std::move(listed),
                            .unlisted = for_bed_of<World>(bed_unlisted_effects()),
                            .restrictions = restrictions(),
                            .expendable = {"foot_velocity_mps", "foot_accel_mps2"},
                            .inputs = {"foot_z_m", "foot_velocity_mps", "foot_accel_mps2"}};
  }());
  return plant;
}

}  // namespace sandhopper::conceal
