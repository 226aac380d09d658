#include "tools/conceal/bed/bed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper::conceal {
namespace {

constexpr double kReferenceDepth_m = 0.02;
constexpr double kOnset_m = 1.5e-3;  // Depth over which forces that depend on speed start.

double fluctuation_at(const BedState& s, double z_m) {
  if (s.fluctuation.size() < 2) return 0.0;
  const double place =
      std::clamp(z_m / kFluctuationGrid_m, 0.0, static_cast<double>(s.fluctuation.size()) - 1.001);
  const auto i = static_cast<std::size_t>(place);
  return s.fluctuation[i] + (place - static_cast<double>(i)) * (s.fluctuation[i + 1] - s.fluctuation[i]);
}

// Factor of the stiffness from earlier pushes and from waiting.
double ageing(const Bed& b, const BedState& s) {
  const double packed = b.hidden.compaction * (1.0 - std::exp(-s.pushes / b.hidden.compaction_pushes));
  return (1.0 + packed) * (1.0 + b.hidden.strengthening * std::log1p(s.wait_s));
}

double stiffness_N_per_m(const Bed& b) {
  return b.per_area_N_per_m3 > 0.0 ? b.per_area_N_per_m3 * b.area_m2() : b.stiffness_N_per_m;
}

// Added mass of the cone of grains under the foot, and its derivative by depth. Source: Aguilar and Goldman,
// Nature Physics 12 (2016).
struct Cone {
  double mass_kg, gradient_kg_per_m;
};
Cone cone(const Bed& b, double z_m) {
  const double kappa = b.recruitment / std::tan(b.band_angle_deg * std::numbers::pi / 180.0);
  const double flat_m = std::max(0.0, b.foot_radius_m - kappa * z_m);
  const double scale = b.added_mass_factor * b.bulk_density_kg_per_m3 * b.recruitment * std::numbers::pi;
  return {scale / (3.0 * kappa) * (std::pow(b.foot_radius_m, 3) - std::pow(flat_m, 3)),
          scale * flat_m * flat_m};
}

// Pushes lower the surface; floor and deepest point keep their place.
double below_surface_m(const Bed& b, const BedState& s, double z_m) {
  return z_m - b.hidden.crater_m_per_push * s.pushes;
}

double bell(double x) { return std::exp(-x * x); }

}  // namespace

double Bed::area_m2() const { return std::numbers::pi * foot_radius_m * foot_radius_m; }

double static_N(const Bed& b, const BedState& s, double z_m) {
  const auto& h = b.hidden;
  const double z = below_surface_m(b, s, z_m);
  if (z <= 0.0) return 0.0;
  const double k = stiffness_N_per_m(b);
  double force = b.per_area_N_per_m3 > 0.0
                     ? k * z * std::pow(z / 0.01, b.exponent - 1.0)
                     : k * (z + b.intercept_depth_m * (1.0 - std::exp(-z / b.intercept_growth_depth_m)));
  if (h.exponent_excess != 0.0) force *= std::pow(std::max(z, 1e-5) / kReferenceDepth_m, h.exponent_excess);
  if (h.floor_stiffening != 0.0)
    force *= 1.0 + h.floor_stiffening * std::exp(-(s.bed_depth_m - z_m) / (0.5 * b.foot_radius_m));
  if (h.tilt_depth_m > 0.0) force *= 1.0 - std::exp(-z / h.tilt_depth_m);
  return force * (1.0 + s.stiffness_relative + fluctuation_at(s, z)) * ageing(b, s);
}

double believed_static_N(Bed bed, double z_m) {
  bed.hidden = {};
  return static_N(bed, {}, z_m);
}

VirginForce virgin(const Bed& b, const BedState& s, double t_s, double z_m, double v_mps) {
  const auto& h = b.hidden;
  const double z = below_surface_m(b, s, z_m);
  if (z <= 0.0) return {0.0, 0.0};
  const double v = std::max(v_mps, 0.0);
  const auto grains = cone(b, z);
  const double quasi_N = static_N(b, s, z_m), in = 1.0 - std::exp(-z / kOnset_m);
  double steady = quasi_N + b.drag_factor * grains.gradient_kg_per_m * v * v +
                  b.steady_drag_coefficient * b.bulk_density_kg_per_m3 * b.area_m2() * v * v;
  double mass = grains.mass_kg * std::clamp(v / b.switch_speed_mps, 0.0, 1.0);

  const double share = std::exp(-z / h.added_mass_depth_m);
  steady += h.added_mass_kg / h.added_mass_depth_m * share * v * v;
  mass += h.added_mass_kg * (1.0 - share) * (1.0 - std::exp(-v / 4e-3));
  steady += in * (h.quadratic_N_s2_per_m2 * v * v + h.viscous_N_s_per_m * v);
  if (s.pushes == 0) steady += h.crust_N * z / (z + h.crust_depth_m);
  steady += h.coupling * quasi_N * v * v / (v * v + h.coupling_speed_mps * h.coupling_speed_mps);
  steady -= h.weakening * quasi_N * bell((v - h.weakening_at_mps) / h.weakening_width_mps);
  steady += h.ripple_N * in * std::sin(2.0 * std::numbers::pi * z / h.ripple_length_m);
  steady += h.layer_N * bell((z - h.layer_at_m) / h.layer_width_m);
  steady -= h.shaken * quasi_N * std::exp(-(t_s - s.touched_s) / h.shaken_s);
  return {steady, mass};
}

double rebound_N(const Bed& b, const BedState& s, double z_m, double v_mps, double damped_mass_kg) {
  const auto& h = b.hidden;
  const double ku = b.unloading_stiffness_ratio / (1.0 + h.unloading_softer) * stiffness_N_per_m(b);
  const double elastic_N = static_N(b, s, s.deepest_m) - ku * (s.deepest_m - z_m);
  double force = 0.0;
  if (elastic_N > 0.0) {
    const double damping = 2.0 * b.unloading_damping_ratio * std::sqrt(ku * damped_mass_kg);
    force = std::max(0.0, elastic_N + damping * v_mps * std::clamp(elastic_N / 5.0, 0.0, 1.0));
    if (h.viscous_N_s_per_m != 0.0) force = std::max(0.0, force + h.viscous_N_s_per_m * v_mps);
  }
  if (const double z = below_surface_m(b, s, z_m); h.suction_N > 0.0 && v_mps < 0.0 && z > 0.0)
    force -= h.suction_N * (1.0 - std::exp(-z / 5e-3)) * (1.0 - std::exp(v_mps / 0.02));
  return force;
}

std::vector<double> draw_fluctuation(double relative_rms, Random random) {
  constexpr double kCorrelation_m = 2e-3;
  const double keep = std::exp(-kFluctuationGrid_m / kCorrelation_m);
  std::vector<double> values(400);
  double value = random.normal(0.0, relative_rms);
  for (double& v : values) {
    v = value;
    value = keep * value + std::sqrt(1.0 - keep * keep) * random.normal(0.0, relative_rms);
  }
  return values;
}

Json terrain_keys(const Bed& b) {
  Json keys = Json::object();
  if (b.per_area_N_per_m3 > 0.0) {
    keys["stiffness_per_area_N_per_m3"] = b.per_area_N_per_m3;
    keys["exponent"] = b.exponent;
  } else {
    keys["stiffness_N_per_m"] = b.stiffness_N_per_m;
    keys["intercept_depth_m"] = b.intercept_depth_m;
    keys["intercept_growth_depth_m"] = b.intercept_growth_depth_m;
  }
  keys["bulk_density_kg_per_m3"] = b.bulk_density_kg_per_m3;
  keys["added_mass_factor"] = b.added_mass_factor;
  keys["drag_factor"] = b.drag_factor;
  keys["added_mass_recruitment"] = b.recruitment;
  keys["added_mass_band_angle_deg"] = b.band_angle_deg;
  keys["steady_drag_coefficient"] = b.steady_drag_coefficient;
  keys["unloading_stiffness_ratio"] = b.unloading_stiffness_ratio;
  keys["unloading_damping_ratio"] = b.unloading_damping_ratio;
  keys["added_mass_switch_speed_mps"] = b.switch_speed_mps;
  return keys;
}

}  // namespace sandhopper::conceal
