#include "tools/conceal/falling_body/world.hpp"

namespace sandhopper::conceal::falling_body {

double heaviness_kg(const World& w);
double top_speed_mps(const World& w);

namespace {

double weight_N(const World& w) { return heaviness_kg(w) * w.gravity_mps2; }

Json gust(World& w, double size, Random& random) {
  w.hidden.gust_N = random.sign() * size * 0.25 * weight_N(w);
  w.hidden.gust_at_m = w.least_release_m * random.uniform(0.3, 0.7);
  w.hidden.gust_width_m = w.least_release_m * random.uniform(0.1, 0.25);
  return {{"peak_N", w.hidden.gust_N}, {"at_m", w.hidden.gust_at_m}, {"width_m", w.hidden.gust_width_m}};
}

Json tether(World& w, double size, Random& random) {
  w.hidden.tether_slack_m = w.least_release_m * random.uniform(0.3, 0.6);
  w.hidden.tether_N_per_m = size * 0.4 * weight_N(w) / w.most_release_m;
  return {{"stiffness_N_per_m", w.hidden.tether_N_per_m}, {"slack_m", w.hidden.tether_slack_m}};
}

Json flutter(World& w, double size, Random& random) {
  const double v = top_speed_mps(w);
  w.hidden.flutter_N = size * 0.25 * weight_N(w) / (v * v);
  w.hidden.flutter_Hz_per_mps = random.uniform(1.0, 2.5);
  return {{"force_N_s2_per_m2", w.hidden.flutter_N}, {"cycles_per_m", w.hidden.flutter_Hz_per_mps}};
}

Json opening(World& w, double size, Random& random) {
  const double v = top_speed_mps(w);
  w.hidden.opening_at_s = random.uniform(0.25, 0.45);
  w.hidden.opening_N_s2 = size * 0.4 * weight_N(w) / (v * v);
  return {{"drag_N_s2_per_m2", w.hidden.opening_N_s2}, {"opens_at_s", w.hidden.opening_at_s}};
}

}  // namespace

std::vector<Recipe<World>> unlisted_effects() {
  return {{{"gust", "body", "u"}, gust},
          {{"tether", "body", "u"}, tether},
          {{"flutter", "body", "u"}, flutter},
          {{"drag_that_opens", "body", "u"}, opening}};
}

// Short drops with a height channel only: the difference between the two laws stays below the noise. In thin
// air without believed buoyancy, only the ratio of drag and mass is observable.
std::vector<Restriction<World>> restrictions() {
  const auto short_drops = [](World& w) {
    w.has_accel = w.has_bed = false;
    w.has_height = true;
    w.least_release_m = 0.8;
    w.most_release_m = 0.9;
    w.height_noise_m = 4e-3;
    w.height_rate_Hz = 60.0;
  };
  const auto in_air = [short_drops](World& w) {
    short_drops(w);
    w.density_kg_per_m3 = 1.2;
    w.mass_kg = 30.0 * w.volume_m3;
    w.buoyancy_factor = w.added_mass_factor = 0.0;
    w.drag_coefficient = 0.5;
    w.most_release_m = 6.0;
  };
  return {{{{"air.quadratic_drag", "air.linear_drag"}}, short_drops},
          {{{"fluid.buoyancy", "fluid.added_mass"}}, short_drops},
          {{{"body.mass", "air.quadratic_drag"}}, in_air}};
}

}  // namespace sandhopper::conceal::falling_body
