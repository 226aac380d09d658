#include "tools/conceal/rotary_axis/world.hpp"

// Effects by which the delivered torque differs from the reported one.
namespace sandhopper::conceal::rotary_axis {
namespace {

Json torque_scale(World& w, double size, Random& random) {
  w.hidden.torque_scale = std::max(-0.5, random.sign() * size * 0.05);
  return {{"scale_error", w.hidden.torque_scale}};
}

Json saturation(World& w, double size, Random&) {
  w.hidden.saturation_torque_Nm = 3.0 * w.gravity_torque_Nm;
  w.hidden.saturation = std::min(0.7, size * 0.25);
  return {{"saturation", w.hidden.saturation}, {"at_torque_Nm", w.hidden.saturation_torque_Nm}};
}

Json delay(World& w, double size, Random&) {
  w.hidden.delay_s = size * 0.004;
  return {{"delay_s", w.hidden.delay_s}};
}

Json cogging(World& w, double size, Random& random) {
  w.hidden.cogging_Nm = size * 0.04 * w.gravity_torque_Nm;
  w.hidden.cogging_per_rev = random.chance(0.5) ? 36.0 : 84.0;
  w.hidden.cogging_phase_rad = random.uniform(0.0, 6.28);
  return {{"amplitude_Nm", w.hidden.cogging_Nm}, {"periods_per_rev", w.hidden.cogging_per_rev}};
}

}  // namespace

std::vector<Recipe<World>> drive_effects() {
  return {{{"axis.torque_scale", "", "torque"}, torque_scale},
          {{"actuator.saturation", "", "torque"}, saturation},
          {{"actuator.delay", "", "clock"}, delay},
          {{"joint.cogging", "", "cogging"}, cogging}};
}

}  // namespace sandhopper::conceal::rotary_axis
