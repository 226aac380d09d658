#include "terrain/falling_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "terrain/accelerometer_fusion.hpp"
#include "terrain/none.hpp"

namespace sandhopper {
namespace {

struct LineThroughSpeeds {
  double at_zero = 0.0, slope = 0.0, deviation = 0.0;
  double operator()(double x) const { return at_zero + slope * x; }
};

LineThroughSpeeds line_through(std::span<const double> x, std::span<const double> y) {
  const double n = static_cast<double>(x.size());
  double sx = 0.0, sy = 0.0, xx = 0.0, xy = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - sx / n) * (x[i] - sx / n);
    xy += (x[i] - sx / n) * (y[i] - sy / n);
  }
  LineThroughSpeeds line;
  line.slope = xx > 0.0 ? xy / xx : 0.0;
  line.at_zero = sy / n - line.slope * sx / n;
  for (std::size_t i = 0; i < x.size(); ++i) squares += std::pow(y[i] - line(x[i]), 2);
  line.deviation = std::sqrt(squares / n);
  return line;
}

}  // namespace

std::size_t find_rest(std::span<const double> specific_force_mps2, std::size_t average_samples,
                      std::size_t rest_samples, double tolerance_mps2) {
  const std::size_t rows = specific_force_mps2.size();
  if (rows <= rest_samples || rest_samples == 0) return rows;
  const auto averaged = moving_average(specific_force_mps2, average_samples);
  const std::size_t known = rows - rest_samples;
  double mean = 0.0;
  for (std::size_t i = known; i < rows; ++i) mean += averaged[i] / static_cast<double>(rest_samples);
  std::size_t first = rows;
  while (first > 0 && std::abs(averaged[first - 1] - mean) < tolerance_mps2) --first;
  return first > known ? rows : first;
}

FallingMotion speed_from_rest(std::span<const double> t_s, std::span<const double> specific_force_mps2,
                              double rest_specific_force_mps2, std::size_t rest_row) {
  FallingMotion out;
  out.rest_row = rest_row;
  double mean = 0.0;
  for (std::size_t i = rest_row; i < t_s.size(); ++i)
    mean += specific_force_mps2[i] / static_cast<double>(t_s.size() - rest_row);
  out.bias_mps2 = rest_specific_force_mps2 - mean;
  out.speed_mps.assign(t_s.size(), 0.0);
  for (std::size_t i = rest_row; i-- > 0;) {
    const double middle = 0.5 * (specific_force_mps2[i] + specific_force_mps2[i + 1]) + out.bias_mps2;
    const double accel = rest_specific_force_mps2 - middle;  // v'
    out.speed_mps[i] = out.speed_mps[i + 1] - accel * (t_s[i + 1] - t_s[i]);
  }
  return out;
}

Touchdown find_touchdown(std::span<const double> t_s, std::span<const double> specific_force_mps2,
                         std::size_t average_samples, double before_s, double sigmas) {
  const auto averaged = moving_average(specific_force_mps2, average_samples);
  Touchdown out;
  out.peak_row =
      static_cast<std::size_t>(std::max_element(averaged.begin(), averaged.end()) - averaged.begin());
  const auto row_at = [&](double time_s) {
    return static_cast<std::size_t>(std::lower_bound(t_s.begin(), t_s.end(), time_s) - t_s.begin());
  };
  const std::size_t from = row_at(t_s[out.peak_row] - before_s);
  const std::size_t to = row_at(t_s[out.peak_row] - before_s / 3.0);
  if (to < from + 10) return {0, out.peak_row};
  const auto line = line_through(t_s.subspan(from, to - from), std::span(averaged).subspan(from, to - from));
  out.row = out.peak_row;
  while (out.row > from && averaged[out.row] - line(t_s[out.row]) > sigmas * line.deviation) --out.row;
  return out;
}

FluidFit fit_fluid(std::span<const double> speed_mps, std::span<const double> specific_force_mps2,
                   double gravity_mps2) {
  if (speed_mps.size() < 10) return {kNone, kNone, kNone, kNone, speed_mps.size()};
  double gg = 0.0, gv = 0.0, vv = 0.0, ga = 0.0, va = 0.0, aa = 0.0;
  for (std::size_t i = 0; i < speed_mps.size(); ++i) {
    const double accel = gravity_mps2 - specific_force_mps2[i];
    const double square = -speed_mps[i] * speed_mps[i];
    gg += gravity_mps2 * gravity_mps2;
    gv += gravity_mps2 * square;
    vv += square * square;
    ga += gravity_mps2 * accel;
    va += square * accel;
    aa += accel * accel;
  }
  const double determinant = gg * vv - gv * gv;
  const double cosine = std::abs(gv) / std::sqrt(gg * vv);
  FluidFit out;
  out.samples = speed_mps.size();
  out.alpha = (vv * ga - gv * va) / determinant;
  out.kappa_per_m = (gg * va - gv * ga) / determinant;
  const double n = static_cast<double>(speed_mps.size());
  out.rms_mps2 = std::sqrt(std::max(aa - out.alpha * ga - out.kappa_per_m * va, 0.0) / n);
  out.condition = std::sqrt((1.0 + cosine) / (1.0 - cosine));
  return out;
}

FluidCoefficients coefficients(const FluidFit& fit, const FluidBody& body) {
  const double displaced_kg = body.density_kg_per_m3 * body.volume_m3;
  const double moving_kg = (body.mass_kg - displaced_kg) / fit.alpha;
  return {.moving_mass_kg = moving_kg,
          .added_mass_factor = (moving_kg - body.mass_kg) / displaced_kg,
          .drag_coefficient =
              2.0 * fit.kappa_per_m * moving_kg / (body.density_kg_per_m3 * body.frontal_area_m2)};
}

}  // namespace sandhopper
