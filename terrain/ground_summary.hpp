#pragma once
#include <array>
#include <cstdint>

#include "config/fields.hpp"
#include "terrain/strength_profile.hpp"

// Summary numbers of a strength profile, with a test of their model: is the bed a line, a power law, or two
// layers? Each model is a linear family of profiles. Smooth departures from it are added (Legendre
// polynomials of the tangent stiffness over the depths visited). Under the model their Wald statistic
// (estimate weighted with its covariance) is chi-squared distributed. The model is rejected at a level of 1
// %.
namespace sandhopper {

enum class GroundShape : std::uint8_t { unknown, line, power_law, crusted, layered, other };
template <>
struct EnumNames<GroundShape> {
  static constexpr std::array<std::string_view, 6> value{"unknown", "line",    "power_law",
                                                         "crusted", "layered", "other"};
};

struct ModelCheck {
  double statistic = 0.0;  // chi-squared
  double limit = 0.0;      // exceeded with a probability of 1 % if the model is right
  bool holds() const noexcept { return limit > 0.0 && statistic <= limit; }

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("statistic", self.statistic);
    visit("limit", self.limit);
  }
};

struct SummaryValue {
  double value = 0.0, ci95_low = 0.0, ci95_high = 0.0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("value", self.value);
    visit("ci95_low", self.ci95_low);
    visit("ci95_high", self.ci95_high);
  }
};

struct GroundSummary {
  std::uint32_t stride = 0;
  GroundShape shape = GroundShape::unknown;
  double from_m = 0.0, to_m = 0.0;  // depth range of the numbers
  SummaryValue line_N_per_m{};      // slope of the line k (z + z0 (1 - exp(-z/dz0)))
  SummaryValue secant_20mm_N_per_m{};
  SummaryValue exponent{};  // of a power law
  ModelCheck line{}, power_law{}, layered{};
  // Stiffness of the line on which the foot leaves its crater and returns (reloading.hpp). The upper end is
  // infinite if the data are consistent with rigid ground. All three are zero without data.
  SummaryValue reloading_N_per_m{};
  bool line_valid = false;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("stride", self.stride);
    visit("shape", self.shape);
    visit("from_m", self.from_m);
    visit("to_m", self.to_m);
    visit("line_N_per_m", self.line_N_per_m);
    visit("secant_20mm_N_per_m", self.secant_20mm_N_per_m);
    visit("exponent", self.exponent);
    visit("line", self.line);
    visit("power_law", self.power_law);
    visit("layered", self.layered);
    visit("reloading_N_per_m", self.reloading_N_per_m);
    visit("line_valid", self.line_valid);
  }
};

GroundSummary summarise(const ProfileSolver& solver) noexcept;

}  // namespace sandhopper
