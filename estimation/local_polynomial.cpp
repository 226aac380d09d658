#include "estimation/local_polynomial.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

constexpr int kMostTerms = 4;

int terms_for(std::size_t samples) {
  if (samples >= 6) return kMostTerms;
  if (samples >= 4) return 3;
  return samples >= 2 ? 2 : 1;
}

// Least squares in u = dt / half_width, so that the normal equations are well scaled.
LocalDerivatives fit_around(std::span<const double> t_s, std::span<const double> values, std::size_t first,
                            std::size_t last, double centre_s, double half_width_s) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  std::size_t samples = 0;
  for (std::size_t i = first; i < last; ++i) {
    if (std::isnan(values[i])) continue;
    const double u = (t_s[i] - centre_s) / half_width_s;
    const double kernel = 1.0 - std::abs(u * u * u);
    const double weight = kernel * kernel * kernel;
    const Eigen::Vector4d powers(1.0, u, u * u, u * u * u);
    normal += weight * powers * powers.transpose();
    right += weight * values[i] * powers;
    samples += weight > 0.0 ? 1 : 0;
  }
  const int n = terms_for(samples);
  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  c.head(n) = normal.topLeftCorner(n, n).ldlt().solve(right.head(n));
  return {c(0), c(1) / half_width_s, 2.0 * c(2) / (half_width_s * half_width_s)};
}

}  // namespace

std::vector<LocalDerivatives> local_polynomial(std::span<const double> t_s, std::span<const double> values,
                                               double half_width_s) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<LocalDerivatives> out(t_s.size(), {kNone, kNone, kNone});
  std::size_t first = 0, last = 0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    while (t_s[first] < t_s[i] - half_width_s) ++first;
    while (last < t_s.size() && t_s[last] <= t_s[i] + half_width_s) ++last;
    if (!std::isnan(values[i])) out[i] = fit_around(t_s, values, first, last, t_s[i], half_width_s);
  }
  return out;
}

}  // namespace sandhopper
