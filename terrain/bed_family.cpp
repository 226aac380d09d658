#include "terrain/bed_family.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

constexpr double kBearingFactor = 6.2;  // N_c of a round foot at the surface; Skempton 1951

}  // namespace

BedFamilyParameters bed_family_of(BedFamily family) noexcept {
  BedFamilyParameters p;
  p.family = family;
  switch (family) {
    case BedFamily::line:
      break;
    case BedFamily::power_law:  // draws within three standard deviations give 0.8 to 1.8
      p.exponent = 1.3;
      p.exponent_spread = 0.5 / 3.0;
      break;
    case BedFamily::soft_over_stiff:  // 1000 N/m on 3600 N/m
      p.strength_factor = 1.0 / 1.5;
      p.deep_strength_ratio = 3.6;
      p.boundary_depth_m = 0.020;
      p.strength_spread_relative = 0.05;
      p.depth_spread_m = 0.002;
      break;
    case BedFamily::stiff_over_soft:  // 2400 N/m on 1000 N/m
      p.strength_factor = 1.6;
      p.deep_strength_ratio = 1.0 / 2.4;
      p.boundary_depth_m = 0.015;
      p.strength_spread_relative = 0.05;
      p.depth_spread_m = 0.002;
      break;
    case BedFamily::crust:  // breaks at 30 N
      p.crust_shear_strength_Pa = 40e3;
      p.strength_spread_relative = 0.10;
      p.depth_spread_m = 0.002;
      break;
    case BedFamily::compacted:
      // Packing 0.63 instead of 0.585: void ratio 0.59 instead of 0.71. By (2.17 - e)^2 / (1 + e) (Hardin and
      // Richart 1963) the elastic stiffness is 1.26 times as large.
      p.strength_factor = 2.4;
      p.density_factor = 1.08;
      p.unloading_stiffness_factor = 1.26;
      break;
    case BedFamily::wet:
      // 500 Pa: capillary cohesion of wet sand and beads (Richefeu et al. 2006; Mitarai and Nori 2006).
      // Porosity 0.4, two thirds filled with water: 1450 + 270 kg/m3.
      p.density_factor = 1.19;
      p.cohesion_Pa = 500.0;
      p.suction_Pa = 2000.0;
      p.strength_spread_relative = 0.15;
      break;
    case BedFamily::gradually_denser:  // 1000 N/m at the surface, approaching 3600 N/m
      p.strength_factor = 1.0 / 1.5;
      p.deep_strength_ratio = 3.6;
      p.densification_depth_m = 0.040;
      p.strength_spread_relative = 0.05;
      break;
  }
  return p;
}

BedFamilyCurve::BedFamilyCurve(const BedFamilyParameters& parameters, double foot_radius_m,
                               double plain_reference_N)
    : p_(parameters),
      plain_(p_.family != BedFamily::power_law && p_.strength_factor == 1.0 &&
             p_.deep_strength_ratio == 1.0 && p_.crust_shear_strength_Pa == 0.0 && p_.cohesion_Pa == 0.0 &&
             p_.floor_depth_m == 0.0),
      area_m2_(std::numbers::pi * foot_radius_m * foot_radius_m),
      rupture_N_(2.0 * std::numbers::pi * foot_radius_m * p_.crust_thickness_m * p_.crust_shear_strength_Pa),
      plain_reference_N_(plain_reference_N) {}

double BedFamilyCurve::deep_share(double depth_m) const noexcept {
  if (p_.densification_depth_m > 0.0) return 1.0 - std::exp(-depth_m / p_.densification_depth_m);
  const double at_surface = 1.0 / (1.0 + std::exp(p_.boundary_depth_m / p_.boundary_width_m));
  const double here = 1.0 / (1.0 + std::exp((p_.boundary_depth_m - depth_m) / p_.boundary_width_m));
  return (here - at_surface) / (1.0 - at_surface);
}

double BedFamilyCurve::crust_N(double depth_m) const noexcept {
  if (rupture_N_ == 0.0) return 0.0;
  const double into_m = depth_m - p_.crust_depth_m;
  if (into_m <= 0.0) return 0.0;
  if (into_m < p_.crust_deflection_m) return rupture_N_ * into_m / p_.crust_deflection_m;
  return rupture_N_ * std::exp(-(into_m - p_.crust_deflection_m) / p_.crust_breakage_length_m);
}

double BedFamilyCurve::force_N(double plain_N, double depth_m) const noexcept {
  const double base_N = p_.family == BedFamily::power_law
                            ? plain_reference_N_ * std::pow(depth_m / p_.reference_depth_m, p_.exponent)
                            : plain_N;
  double force_N = p_.strength_factor * base_N;
  if (p_.deep_strength_ratio != 1.0) force_N *= 1.0 + (p_.deep_strength_ratio - 1.0) * deep_share(depth_m);
  if (p_.cohesion_Pa > 0.0)
    force_N += kBearingFactor * p_.cohesion_Pa * area_m2_ * (1.0 - std::exp(-depth_m / p_.cohesion_depth_m));
  if (p_.floor_depth_m > 0.0)
    force_N += p_.floor_stiffness_N_per_m * std::max(0.0, depth_m - p_.floor_depth_m);
  return force_N + crust_N(depth_m);
}

double BedFamilyCurve::suction_N(double above_floor_m, double floor_m) const noexcept {
  // A crater shallower than suction_distance_m releases the foot at the surface.
  const double length_m = std::min(p_.suction_distance_m, floor_m);
  if (p_.suction_Pa == 0.0 || above_floor_m <= 0.0 || above_floor_m >= length_m) return 0.0;
  const double u = above_floor_m / length_m;
  return p_.suction_Pa * area_m2_ * 6.75 * u * (1.0 - u) * (1.0 - u);
}

}  // namespace sandhopper
