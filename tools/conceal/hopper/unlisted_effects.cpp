#include "tools/conceal/hopper/world.hpp"

namespace sandhopper::conceal::hopper {
namespace {

// Additional friction at one height of the rail.
Json bump(World& w, double size, Random& random) {
  w.hidden.bump_N = size * 8.0;
  w.hidden.bump_at_m = random.uniform(0.36, 0.42);
  w.hidden.bump_width_m = random.uniform(0.008, 0.02);
  return {{"peak_N", w.hidden.bump_N}, {"at_m", w.hidden.bump_at_m}, {"width_m", w.hidden.bump_width_m}};
}

Json magnet(World& w, double size, Random& random) {
  w.hidden.magnet_Nm = size * 0.5;
  w.hidden.magnet_at_rad = random.uniform(0.9, 1.3);
  w.hidden.magnet_width_rad = random.uniform(0.05, 0.12);
  return {{"peak_Nm", w.hidden.magnet_Nm},
          {"at_rad", w.hidden.magnet_at_rad},
          {"width_rad", w.hidden.magnet_width_rad}};
}

Json hysteretic_spring(World& w, double size, Random& random) {
  w.hidden.spring_yield_rad = random.uniform(0.15, 0.4);
  w.hidden.spring_Nm_per_rad = size * 0.4 / w.hidden.spring_yield_rad;
  return {{"stiffness_Nm_per_rad", w.hidden.spring_Nm_per_rad}, {"yield_rad", w.hidden.spring_yield_rad}};
}

Json hum(World& w, double size, Random& random) {
  w.hidden.hum_Nm = size * 0.5;
  w.hidden.hum_Hz = random.uniform(20.0, 60.0);
  return {{"amplitude_Nm", w.hidden.hum_Nm}, {"frequency_Hz", w.hidden.hum_Hz}};
}

}  // namespace

std::vector<Recipe<World>> unlisted_effects() {
  return {{{"burr_on_the_rail", "rail", "u"}, bump},
          {{"magnet_at_an_angle", "joint", "u"}, magnet},
          {{"hysteretic_leg_spring", "joint", "u"}, hysteretic_spring},
          {{"torque_hum", "actuator", "u"}, hum}};
}

// Indistinguishable pairs. A latency and a late clock of the time-of-flight sensor are the same. A tilted
// accelerometer reads less, like one with a gain error. If all drops are alike, links and foot move almost
// alike.
std::vector<Restriction<World>> restrictions() {
  const auto as_is = [](World&) {};
  const auto same_drops = [](World& w) { w.same_drops = true, w.sensors.mocap = false; };
  return {{{{"tof.latency", "clock.skew"}}, as_is},
          {{{"leg.link_mass", "foot.mass"}}, same_drops},
          {{{"imu.tilt", "imu.scale"}}, as_is}};
}

}  // namespace sandhopper::conceal::hopper
