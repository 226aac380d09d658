#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/falling_body/world.hpp"
#include "tools/conceal/plants.hpp"

namespace sandhopper::conceal {

const Plant& falling_body_plant() {
  using namespace falling_body;
  static const PlantOf<World> plant([] {
    auto listed = fluid_effects();
    append(listed, sensor_effects());
    return PlantSpec<World>{"falling_body",     draw,           belief,
                            draw_setups,        record,         std::move(listed),
                            unlisted_effects(), restrictions(), {}};
  }());
  return plant;
}

}  // namespace sandhopper::conceal
