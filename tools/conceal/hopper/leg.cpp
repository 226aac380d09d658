#include "tools/conceal/hopper/leg.hpp"

#include <cmath>

namespace sandhopper::conceal::hopper {
namespace {

// Angle of the lower link from the vertical: lower sin(psi) = hip offset + upper sin(phi).
Curve lower_angle(const Robot& r, double phi) {
  const double sine = (r.hip_offset_m + r.upper_m * std::sin(phi)) / r.lower_m,
               cosine = std::sqrt(1.0 - sine * sine);
  Curve psi;
  psi.value = std::asin(sine);
  psi.first = r.upper_m * std::cos(phi) / (r.lower_m * cosine);
  psi.second = (psi.first * psi.first * sine - r.upper_m * std::sin(phi) / r.lower_m) / cosine;
  return psi;
}

// scale x cos(angle) and scale x sin(angle), with derivatives by phi.
Curve cosine_of(const Curve& angle, double scale) {
  const double c = scale * std::cos(angle.value), s = scale * std::sin(angle.value);
  return {c, -s * angle.first, -c * angle.first * angle.first - s * angle.second};
}
Curve sine_of(const Curve& angle, double scale) {
  const double c = scale * std::cos(angle.value), s = scale * std::sin(angle.value);
  return {s, c * angle.first, -s * angle.first * angle.first + c * angle.second};
}
Curve operator+(const Curve& a, const Curve& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}

void add_body(Leg& leg, double mass_kg, double inertia_kg_m2, const Curve& x, const Curve& z,
              const Curve& angle) {
  leg.mass_kg += mass_kg;
  leg.first_kg_m += mass_kg * z.first;
  leg.second_kg_m2 +=
      mass_kg * (z.first * z.first + x.first * x.first) + inertia_kg_m2 * angle.first * angle.first;
  leg.first_rate_kg_m += mass_kg * z.second;
  leg.second_rate_kg_m2 +=
      mass_kg * (z.first * z.second + x.first * x.second) + inertia_kg_m2 * angle.first * angle.second;
}

}  // namespace

Curve hip_over_toe(const Robot& r, double angle_rad) {
  return cosine_of({angle_rad, 1.0, 0.0}, r.upper_m) + cosine_of(lower_angle(r, angle_rad), r.lower_m);
}

double angle_for(const Robot& r, double hip_over_toe_m) {
  double low = 0.05, high = 2.9;  // The leg shortens as the angle grows.
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (hip_over_toe(r, middle).value > hip_over_toe_m ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Leg leg_at(const Robot& r, double payload_kg, double angle_rad) {
  const Curve phi{angle_rad, 1.0, 0.0}, psi = lower_angle(r, angle_rad);
  Leg leg;
  leg.hip_m = cosine_of(phi, r.upper_m) + cosine_of(psi, r.lower_m);
  add_body(leg, r.body_kg + payload_kg, 0.0, {}, leg.hip_m, {});
  add_body(leg, 2.0 * r.upper_kg, 2.0 * r.upper_kg_m2, sine_of(phi, r.upper_com_m),
           leg.hip_m + cosine_of(phi, -r.upper_com_m), phi);
  const double over_toe_m = r.lower_m - r.lower_com_m;
  add_body(leg, 2.0 * r.lower_kg, 2.0 * r.lower_kg_m2, sine_of(psi, over_toe_m), cosine_of(psi, over_toe_m),
           psi);
  return leg;
}

}  // namespace sandhopper::conceal::hopper
