#include "terrain/resistance_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

constexpr double kReferenceDepth_m = 0.1;

bool has_exponent(ResistanceLaw law) {
  return law == ResistanceLaw::depth_power || law == ResistanceLaw::depth_power_rate ||
         law == ResistanceLaw::depth_power_square;
}
bool has_rate(ResistanceLaw law) {
  return law == ResistanceLaw::depth_power_rate || law == ResistanceLaw::depth_power_square;
}

bool counts(const ResistanceSample& sample) { return sample.depth_m > 0.0 && sample.speed_mps > 0.0; }

// Best strength of one penetration and its mean squared residual.
struct OwnStrength {
  double strength, mean_square;
};
OwnStrength own_strength(ResistanceLaw law, double exponent, double rate, const Penetration& penetration) {
  double ss = 0.0, sr = 0.0, rr = 0.0, n = 0.0;
  for (const auto& sample : penetration) {
    if (!counts(sample)) continue;
    const double s = resistance(law, exponent, rate, 1.0, sample.depth_m, sample.speed_mps);
    ss += s * s;
    sr += s * sample.resistance;
    rr += sample.resistance * sample.resistance;
    n += 1.0;
  }
  if (!(ss > 0.0)) return {0.0, std::numeric_limits<double>::infinity()};
  return {sr / ss, std::max(rr - sr * sr / ss, 0.0) / n};
}

double mean_square(ResistanceLaw law, double exponent, double rate, std::span<const Penetration> all) {
  double sum = 0.0;
  for (const auto& penetration : all) sum += own_strength(law, exponent, rate, penetration).mean_square;
  return sum / static_cast<double>(all.size());
}

struct Shape {
  double exponent = 1.0, rate = 0.0, mean_square = std::numeric_limits<double>::infinity();
};

// Grid search that narrows around its best point. Sufficient for at most two dimensions and a smooth surface.
Shape search(ResistanceLaw law, std::span<const Penetration> all) {
  const bool power_rate = law == ResistanceLaw::depth_power_rate;
  Shape best;
  double n0 = 2.0, b0 = power_rate ? 0.5 : 0.0;
  double dn = has_exponent(law) ? 0.2 : 0.0, db = !has_rate(law) ? 0.0 : power_rate ? 0.1 : 0.02;
  const int ni = has_exponent(law) ? 9 : 0, bi = has_rate(law) ? 10 : 0;
  for (int round = 0; round < 6; ++round) {
    for (int i = -ni; i <= ni; ++i)
      for (int j = -bi; j <= bi; ++j) {
        const double n = has_exponent(law) ? std::max(n0 + i * dn, 0.05) : 1.0;
        const double b = b0 + j * db;
        const double square = mean_square(law, n, b, all);
        if (square < best.mean_square) best = {n, b, square};
      }
    n0 = best.exponent;
    b0 = best.rate;
    dn *= 0.25;
    db *= 0.25;
  }
  return best;
}

}  // namespace

double resistance(ResistanceLaw law, double exponent, double rate, double strength, double depth_m,
                  double speed_mps) {
  const double z = depth_m / kReferenceDepth_m;
  switch (law) {
    case ResistanceLaw::depth:
      return strength * z;
    case ResistanceLaw::depth_power:
      return strength * std::pow(z, exponent);
    case ResistanceLaw::depth_power_rate:
      return strength * std::pow(z, exponent) * std::pow(speed_mps, rate);
    case ResistanceLaw::depth_power_square:
      return strength * (std::pow(z, exponent) + rate * speed_mps * speed_mps);
    case ResistanceLaw::speed_square:
      return strength * speed_mps * speed_mps;
  }
  return 0.0;
}

ResistanceFit fit_resistance(ResistanceLaw law, std::span<const Penetration> penetrations) {
  const auto shape = search(law, penetrations);
  ResistanceFit out{law, shape.exponent, shape.rate, {}, std::sqrt(shape.mean_square)};
  for (const auto& penetration : penetrations)
    out.strength.push_back(own_strength(law, shape.exponent, shape.rate, penetration).strength);
  return out;
}

std::vector<double> cross_validate(ResistanceLaw law, std::span<const Penetration> penetrations) {
  std::vector<double> out;
  for (std::size_t left_out = 0; left_out < penetrations.size(); ++left_out) {
    std::vector<Penetration> rest(penetrations.begin(), penetrations.end());
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    if (rest.empty()) return {std::numeric_limits<double>::quiet_NaN()};
    const auto shape = search(law, rest);
    const auto& own = penetrations[left_out];
    double greatest = 0.0;
    for (const auto& sample : own) greatest = std::max(greatest, sample.resistance);
    out.push_back(std::sqrt(own_strength(law, shape.exponent, shape.rate, own).mean_square) / greatest);
  }
  return out;
}

double depth_speed_correlation(const Penetration& penetration) {
  double n = 0.0, sz = 0.0, sv = 0.0, zz = 0.0, vv = 0.0, zv = 0.0;
  for (const auto& sample : penetration) {
    if (!counts(sample)) continue;
    const double z = std::log(sample.depth_m), v = std::log(sample.speed_mps);
    n += 1.0;
    sz += z;
    sv += v;
    zz += z * z;
    vv += v * v;
    zv += z * v;
  }
  return (zv - sz * sv / n) / std::sqrt((zz - sz * sz / n) * (vv - sv * sv / n));
}

}  // namespace sandhopper
