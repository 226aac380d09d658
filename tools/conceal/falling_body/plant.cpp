#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/core/phases.hpp"
#include "tools/conceal/falling_body/world.hpp"
#include "tools/conceal/plants.hpp"

namespace sandhopper::conceal {

const Plant& falling_body_plant() {
  using namespace falling_body;
  static const PlantOf<World> plant([] {
    auto listed = fluid_effects();
    append(listed, sensor_effects());
    return PlantSpec<World>{.name = "falling_body",
                            .draw = draw,
                            .belief = belief,
                            .draw_setups = draw_setups,
                            .record = record,
                            .phases = thirds_of_time<World>,
                            .listed = std::move(listed),
                            .unlisted = unlisted_effects(),
                            .restrictions = restrictions(),
                            .expendable = {},
                            .inputs = {}};
  }());
  return plant;
}

}  // namespace sandhopper::conceal
