#include "tools/conceal/core/fault_recipes.hpp"
#include "tools/conceal/rotary_axis/world.hpp"

namespace sandhopper::conceal::rotary_axis {
namespace {

Json bias(World& w, double size, Random& random) {
  const bool torque = random.chance(0.5);
  const double bias = random.sign() * size * (torque ? 0.05 * w.gravity_torque_Nm : 0.15);
  w.faults[torque ? "torque_Nm" : "velocity_radps"].offset += bias;
  return {{"channel", torque ? "torque_Nm" : "velocity_radps"}, {"bias", bias}};
}

// The reported velocity is clipped; a larger size means a lower limit.
Json velocity_saturation(World& w, double size, Random&) {
  const double limit_radps = 4.0 / (1.0 + size);
  w.faults["velocity_radps"].limit = limit_radps;
  return {{"channel", "velocity_radps"}, {"limit", limit_radps}};
}

Json eccentricity(World& w, double size, Random& random) {
  w.eccentricity_rad = size * 0.02;
  w.eccentricity_phase_rad = random.uniform(0.0, 6.28);
  return {{"amplitude_rad", w.eccentricity_rad}, {"phase_rad", w.eccentricity_phase_rad}};
}

}  // namespace

std::vector<Recipe<World>> sensor_effects() {
  auto all = data_fault_recipes<World>(
      [](const World&) {
        return std::vector<std::string>{"position_rad", "velocity_radps", "torque_Nm"};
      },
      0.004);
  append(all, {{{"sensor.bias", "", "offset"}, bias},
               {{"sensor.saturation", "", "data"}, velocity_saturation},
               {{"encoder.eccentricity", "", "offset"}, eccentricity}});
  return all;
}

}  // namespace sandhopper::conceal::rotary_axis
