#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "config/fields.hpp"

// Resistance of a bed against depth and speed along one or several penetrations. Every penetration has its
// own strength k, because beds differ from place to place; the shape of the law is common.
namespace sandhopper {

enum class ResistanceLaw : std::uint8_t {
  depth,               // r = k z
  depth_power,         // r = k (z / 0.1 m)^n
  depth_power_rate,    // r = k (z / 0.1 m)^n (v / 1 m/s)^b: rate strengthening of a soft bed
  depth_power_square,  // r = k ((z / 0.1 m)^n + b (v / 1 m/s)^2): with inertial drag
  speed_square         // r = k (v / 1 m/s)^2: a fluid
};
template <>
struct EnumNames<ResistanceLaw> {
  static constexpr std::array<std::string_view, 5> value{"depth", "depth_power", "depth_power_rate",
                                                         "depth_power_square", "speed_square"};
};

struct ResistanceSample {
  double depth_m;
  double speed_mps;
  double resistance;  // per moving mass [m/s^2], or a force [N]
};
using Penetration = std::vector<ResistanceSample>;

struct ResistanceFit {
  ResistanceLaw law{};
  double exponent = 0.0;         // n
  double rate = 0.0;             // b
  std::vector<double> strength;  // k of each penetration, in the resistance's unit
  double rms = 0.0;              // root of the mean over penetrations of the mean squared residual
};

// Least squares with the same weight for every penetration. Samples without depth or speed are left out.
ResistanceFit fit_resistance(ResistanceLaw law, std::span<const Penetration> penetrations);

// Leave-one-out cross-validation: the shape is fitted to the other penetrations, the strength to the one left
// out. Returns the rms residual of each relative to its largest resistance.
std::vector<double> cross_validate(ResistanceLaw law, std::span<const Penetration> penetrations);

// Value of the law at one depth and speed, in the strength's unit.
double resistance(ResistanceLaw law, double exponent, double rate, double strength, double depth_m,
                  double speed_mps);

// Correlation of ln z and ln v along a penetration. Near -1 or 1 one penetration cannot separate depth from
// rate.
double depth_speed_correlation(const Penetration& penetration);

}  // namespace sandhopper
