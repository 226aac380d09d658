#include "tools/conceal/core/fault_recipes.hpp"
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
    return PlantSpec<World>{"rotary_axis",      draw,           belief,
                            draw_setups,        record,         std::move(listed),
                            unlisted_effects(), restrictions(), {"velocity_radps", "load_cell_torque_Nm"}};
  }());
  return plant;
}

}  // namespace sandhopper::conceal
