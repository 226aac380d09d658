#include <algorithm>

#include "tools/conceal/hopper/world.hpp"

// Effects of motors, drives and the controller's configuration.
namespace sandhopper::conceal::hopper {
namespace {

Json torque_constant(World& w, double size, Random& random) {
  w.hidden.torque_constant = random.sign() * size * 0.06;
  return {{"scale_error", w.hidden.torque_constant}};
}

Json saturation(World& w, double size, Random&) {
  w.hidden.saturation = std::min(0.6, size * 0.15);
  return {{"saturation", w.hidden.saturation}};
}

Json temperature(World& w, double size, Random&) {
  w.hidden.derating_per_K = std::min(6e-3, size * 1.5e-3);
  return {{"derating_per_K", w.hidden.derating_per_K}};
}

// Voltage that allows the current 32 A / (1 + 0.33 size) at a motor speed of 15 rad/s.
Json voltage(World& w, double size, Random&) {
  w.hidden.supply_V = 15.0 * w.drive.torque_constant_Nm_per_A + 0.125 * 32.0 / (1.0 + 0.33 * size);
  return {{"supply_V", w.hidden.supply_V}};
}

Json delay(World& w, double size, Random&) {
  w.hidden.delay_s = size * 2.5e-3;
  return {{"delay_s", w.hidden.delay_s}};
}

Json not_as_configured(World& w, double size, Random& random) {
  const int which = random.below(3);
  const double share = random.sign() * size * 0.08;
  if (which == 0) w.hidden.compression_gain = share;
  if (which == 1) w.hidden.extension_gain = share;
  if (which == 2) w.hidden.switch_late_m = size * 0.03;
  return {{"what", which == 0   ? "compression gain"
                   : which == 1 ? "extension gain"
                                : "switch rule"},
          {"value", which == 2 ? w.hidden.switch_late_m : share}};
}

}  // namespace

std::vector<Recipe<World>> drive_effects() {
  return {{{"actuator.torque_constant", "", "torque"}, torque_constant},
          {{"actuator.saturation", "", "torque"}, saturation},
          {{"actuator.temperature", "", "torque"}, temperature},
          {{"actuator.voltage_limit", "", "torque"}, voltage},
          {{"actuator.delay", "", "clock"}, delay},
          {{"controller.not_as_configured", "", "controller"}, not_as_configured}};
}

}  // namespace sandhopper::conceal::hopper
