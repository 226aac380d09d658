#pragma once
#include <cmath>
#include <complex>
#include <functional>
#include <random>

#include "terrain/strength_profile.hpp"

// Pushes of a foot into ground of a known curve, for the tests of the strength profile.
namespace sandhopper {

inline constexpr double kRadius_m = 0.040;
inline constexpr double kReducedMass_kg = 0.68;
using Curve = std::function<double(double)>;

inline double line_N(double z) { return 1500.0 * (z + 0.003 * (1.0 - std::exp(-z / 0.003))); }
inline double power_N(double z) { return 49.5 * std::pow(z / 0.030, 1.4); }
inline double layers_N(double z) { return line_N(z) * (0.7 + 1.8 / (1.0 + std::exp((0.020 - z) / 0.002))); }

// The belief that no drag stays at depth: its error is the same in all strides, so they do not average it
// out.
inline StiffnessConfig without_steady_drag() {
  StiffnessConfig config;
  config.profile = ProfileConfig{.steady_drag_sd = 1e-6};
  return config;
}

struct Push {
  double speed_mps = 0.8;
  double to_m = 0.045;
  double noise_N = 0.3;
  double too_deep_m = 0.0, depth_drift_mps = 0.0;
  double steady_drag = 0.0;  // lambda
  double added_mass = 1.0;   // c
  unsigned seed = 1;
  double lasts = 3.5;    // in units of to_m / speed_mps
  bool contact = false;  // the contact's speed is known, and the depth has the errors of the filter and lag
};

// Error of the Kalman filter's height since the contact, at 1 ms steps: the real part of a complex process
// with the correlation exp((i - 1) a t).
class FilterError {
 public:
  explicit FilterError(unsigned seed) : engine_(seed), first_(draw()), now_(first_) {}
  double next_m() {
    const std::complex<double> keep =
        std::exp(std::complex<double>(-1.0, 1.0) * prior_.filter_decay_per_s * 1e-3);
    now_ = keep * now_ + std::sqrt(1.0 - std::norm(keep)) * draw();
    return prior_.filter_sd_m * (now_ - first_).real();
  }

 private:
  std::complex<double> draw() { return {normal_(engine_), normal_(engine_)}; }
  ProfileConfig prior_{};
  std::mt19937 engine_;
  std::normal_distribution<double> normal_{};
  std::complex<double> first_, now_;
};

// A foot that slows down while it enters virgin ground with drag and added mass.
inline ProfileSums sums_of(const Curve& curve, const Push& push) {
  const Bed cone(BedParameters{}, kRadius_m);
  ProfileRegression regression({}, kRadius_m, kReducedMass_kg);
  if (push.contact) regression.on_contact(push.speed_mps);
  std::mt19937 engine(push.seed);
  std::normal_distribution<double> noise(0.0, push.noise_N);
  FilterError filter(push.seed + 1000);
  const double rate = push.speed_mps / push.to_m;
  for (double t = 1e-3; rate * t < push.lasts; t += 1e-3) {
    const double z = push.to_m * (1.0 - std::exp(-rate * t));
    const double v = push.speed_mps * std::exp(-rate * t), a = -rate * v;
    const double drag_kg_per_m = push.added_mass * cone.added_mass_gradient_kg_per_m(z) +
                                 push.steady_drag * steady_drag_kg_per_m(kRadius_m);
    const double force = curve(z) + drag_kg_per_m * v * v + push.added_mass * cone.added_mass_kg(z) * a;
    double depth_m = z + push.too_deep_m + push.depth_drift_mps * t;
    if (push.contact) depth_m += ProfileConfig{}.depth_lag_s * (push.speed_mps - v) + filter.next_m();
    regression.add({depth_m, v, a, force + noise(engine), -0.1, t, 1e-3}, force);
  }
  return regression.sums();
}

inline ProfileSolver solved(const Curve& curve, const Push& push) {
  ProfileSolver solver{StiffnessConfig{}};
  solver.add(sums_of(curve, push), 1);
  return solver;
}

}  // namespace sandhopper
