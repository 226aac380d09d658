#include "tools/diagnose/plants/intruder/bed_grains.hpp"

#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {

BedGrains::BedGrains(double relative, double length_m, double deepest_m, double spacing_m,
                     std::size_t most_knots) {
  if (relative <= 0.0 || deepest_m <= 0.0) return;
  relative_ = relative;
  length_m_ = length_m;
  spacing_m_ = spacing_m;
  // Integral over depth of one knot's weight in the interpolation of unit variance, in spacings: twice the
  // integral of u / sqrt(u^2 + (1 - u)^2) from 0 to 1, which is sqrt(2) asinh(1).
  constexpr double kPart = 1.2465;
  const double wanted = 2.0 * length_m_ / (kPart * kPart * spacing_m_);
  keep_ = (wanted - 1.0) / (wanted + 1.0);
  count_ = std::min(most_knots, static_cast<std::size_t>(deepest_m / spacing_m_) + 2);
}

double BedGrains::between_knots() const {
  return count_ > 0 ? relative_ * std::sqrt(std::min(1.0, spacing_m_ / (3.0 * length_m_))) : 0.0;
}

BedFluctuation BedGrains::fluctuation(std::span<const double> nuisances) const {
  BedFluctuation f;
  if (count_ == 0) return f;
  f.relative = 1.0;
  f.spacing_m = spacing_m_;
  const double fresh = std::sqrt(1.0 - keep_ * keep_);
  for (std::size_t i = 0; i < count_; ++i)
    f.knots[i] = i == 0 ? nuisances[0] : keep_ * f.knots[i - 1] + fresh * nuisances[i];
  return f;
}

}  // namespace sandhopper::diagnose
