#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/core/phases.hpp"
#include "tools/conceal/plants.hpp"
#include "tools/conceal/rotary_axis/world.hpp"

namespace sandhopper::conceal {

const Plant& rotary_axis_plant() {
  using namespace rotary_axis;
  static const PlantOf<World> plant([] {
    auto listed = friction_effects();
    append(listed, load_effects());
    append(listed, drive_effects());
    append(listed, sensor_effects());
    return PlantSpec<World>{.name = "rotary_axis",
                            .draw = draw,
                            .belief = belief,
                            .draw_setups = draw_setups,
                            .record = record,
                            .phases = thirds_of_time<World>,
                            .listed = std::move(listed),
                            .unlisted = unlisted_effects(),
                            .restrictions = restrictions(),
                            .expendable = {"velocity_radps", "load_cell_torque_Nm"},
                            // Both are readings of the torque that moves the axis.
                            .inputs = {"torque_Nm", "load_cell_torque_Nm"}};
  }());
  return plant;
}

}  // namespace sandhopper::conceal
