#include "terrain/bed.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sandhopper {
namespace {

constexpr double kDampingRamp_N = 5.0;  // damping fades with the elastic force, so that liftoff has no force
                                        // step
constexpr double kExponentDepth_m =
    0.01;  // depth at which the power law has the stiffness of its coefficient

double square(double x) noexcept { return x * x; }

}  // namespace

double BedFluctuation::factor(double depth_m) const noexcept {
  if (relative == 0.0) return 1.0;
  const double place = std::clamp(depth_m / spacing_m, 0.0, static_cast<double>(kKnots - 1) - 1e-9);
  const auto knot = static_cast<std::size_t>(place);
  const double u = place - static_cast<double>(knot);
  const double weight = std::sqrt(square(1.0 - u) + square(u));
  return 1.0 + relative * ((1.0 - u) * knots[knot] + u * knots[knot + 1]) / weight;
}

Bed::Bed(const BedParameters& parameters, double foot_radius_m, const BedFluctuation& fluctuation,
         const BedFamilyParameters& family)
    : p_(parameters),
      fluctuation_(fluctuation),
      radius_m_(foot_radius_m),
      area_m2_(std::numbers::pi * square(foot_radius_m)),
      cone_slope_(p_.added_mass_recruitment /
                  std::tan(p_.added_mass_band_angle_deg * std::numbers::pi / 180.0)),
      gradient_scale_kg_per_m3_(p_.added_mass_factor * p_.bulk_density_kg_per_m3 * p_.added_mass_recruitment *
                                std::numbers::pi) {
  gradient_scale_kg_per_m3_ *= family.density_factor;
  family_ = BedFamilyCurve(family, foot_radius_m, plain_curve_N(family.reference_depth_m));
}

double Bed::stiffness_N_per_m() const noexcept {
  return p_.stiffness_per_area_N_per_m3 > 0.0 ? p_.stiffness_per_area_N_per_m3 * area_m2_
                                              : p_.stiffness_N_per_m;
}

double Bed::unloading_line_N_per_m() const noexcept {
  return p_.unloading_stiffness_ratio * stiffness_N_per_m() *
         family_.parameters().unloading_stiffness_factor *
         (extension_ ? extension_->unloading_factor() : 1.0);
}

double Bed::quasi_static_force_N(double depth_m) const noexcept {
  return depth_m <= 0.0 ? 0.0 : extended_N(curve_N(depth_m), depth_m);
}

double Bed::extended_N(double curve_N, double depth_m) const noexcept {
  return extension_ ? extension_->quasi_static_N(curve_N, depth_m) : curve_N;
}

double Bed::plain_curve_N(double depth_m) const noexcept {
  const double depth =
      p_.stiffness_per_area_N_per_m3 > 0.0
          ? depth_m * std::pow(depth_m / kExponentDepth_m, p_.exponent - 1.0)
          : depth_m + p_.intercept_depth_m * (1.0 - std::exp(-depth_m / p_.intercept_growth_depth_m));
  return stiffness_N_per_m() * depth;
}

double Bed::curve_N(double depth_m) const noexcept {
  if (depth_m <= 0.0) return 0.0;
  const double plain_N = plain_curve_N(depth_m);
  return (family_.plain() ? plain_N : family_.force_N(plain_N, depth_m)) * fluctuation_.factor(depth_m);
}

double Bed::added_mass_gradient_kg_per_m(double depth_m) const noexcept {
  return gradient_scale_kg_per_m3_ * square(std::max(0.0, radius_m_ - cone_slope_ * std::max(0.0, depth_m)));
}

double Bed::added_mass_kg(double depth_m) const noexcept {
  const double flat = std::max(0.0, radius_m_ - cone_slope_ * std::max(0.0, depth_m));
  return gradient_scale_kg_per_m3_ / (3.0 * cone_slope_) *
         (radius_m_ * square(radius_m_) - flat * square(flat));
}

BedReaction Bed::reaction(const BedContact& c) const noexcept {
  if (c.depth_m <= 0.0) return {};
  const bool virgin = c.depth_m >= c.max_depth_m && c.speed_mps > 0.0;
  const double bears_N = virgin || extension_ ? quasi_static_force_N(c.depth_m) : 0.0;
  BedReaction r = virgin ? going_deeper(c, bears_N) : unloading(c);
  if (extension_) {
    const BedReaction more = extension_->added(c, bears_N, r.force_N, virgin);
    r.force_N += more.force_N;
    r.added_mass_kg += more.added_mass_kg;
    r.least_N += more.least_N;
  }
  return r;
}

BedReaction Bed::going_deeper(const BedContact& c, double bears_N) const noexcept {
  const double drag_kg_per_m =
      p_.drag_factor * added_mass_gradient_kg_per_m(c.depth_m) +
      p_.steady_drag_coefficient * p_.bulk_density_kg_per_m3 * area_m2_ * family_.parameters().density_factor;
  const double engaged = std::min(1.0, c.speed_mps / p_.added_mass_switch_speed_mps);
  return {.force_N = bears_N + drag_kg_per_m * square(c.speed_mps),
          .added_mass_kg = engaged * added_mass_kg(c.depth_m)};
}

BedReaction Bed::unloading(const BedContact& c) const noexcept {
  const double line_N_per_m = unloading_line_N_per_m();
  const double deepest_N =
      c.deepest_N >= 0.0 ? extended_N(c.deepest_N, c.max_depth_m) : quasi_static_force_N(c.max_depth_m);
  const double elastic_N = deepest_N - line_N_per_m * (c.max_depth_m - c.depth_m);
  if (elastic_N <= 0.0) {
    if (family_.parameters().suction_Pa == 0.0) return {};
    const double pull_N = suction_N(c, -elastic_N / line_N_per_m);
    return {.force_N = -pull_N, .least_N = -pull_N};
  }
  const double damping_N_s_per_m =
      2.0 * p_.unloading_damping_ratio * std::sqrt(line_N_per_m * c.damping_mass_kg);
  const double force_N =
      elastic_N + damping_N_s_per_m * c.speed_mps * std::min(1.0, elastic_N / kDampingRamp_N);
  return {.force_N = std::max(0.0, force_N)};
}

double Bed::suction_N(const BedContact& c, double above_floor_m) const noexcept {
  const double leaving = std::clamp(-c.speed_mps / p_.added_mass_switch_speed_mps, 0.0, 1.0);
  return leaving * family_.suction_N(above_floor_m, c.depth_m + above_floor_m);
}

double Bed::greatest_stiffness_N_per_m(double to_depth_m) const noexcept {
  constexpr double kStep_m = 1e-4;
  double greatest = 0.0, before_N = curve_N(kStep_m);
  for (int i = 2; i * kStep_m <= to_depth_m; ++i) {
    const double here_N = curve_N(i * kStep_m);
    greatest = std::max(greatest, (here_N - before_N) / kStep_m);
    before_N = here_N;
  }
  return greatest;
}

double Bed::crater_floor_m(double max_depth_m) const noexcept {
  const double line_N_per_m = unloading_line_N_per_m();
  return line_N_per_m > 0.0 ? max_depth_m - quasi_static_force_N(max_depth_m) / line_N_per_m : max_depth_m;
}

}  // namespace sandhopper
