#include "terrain/reloading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

// An unloading foot accelerates by less than about twice gravity, an impact by more.
constexpr double kImpact_mps2 = 20.0;
// The trace begins at 95 % of the largest force, so that noise at the peak does not restart it. It ends at a
// tenth of that force, where the foot begins to leave.
constexpr double kBegins = 0.95, kEnds = 0.1;
constexpr double kLeastForce_N = 5.0;
constexpr std::int32_t kLeastPairs = 10;
constexpr double kPair_s = 0.002;
// Range of the stiffness grid relative to the believed bed. The credible ratio of unloading to loading
// stiffness is 10 to 100, on beds up to 2.4 times as stiff as the believed one.
constexpr double kLeastRatio = 3.0, kGreatestRatio = 600.0;
// Above this ratio the foot's motion is smaller than the accelerometer's noise can resolve: rigid ground
// gives 90 to 190 kN/m (strength_profile_test). So a larger value is no upper end of the interval.
constexpr double kResolvedRatio = 100.0;
// Damping ratio with a uniform prior from none to nearly critical. The log-likelihood is a parabola in it,
// because the force is linear in the damping.
constexpr std::array<double, 3> kDampingRatios{0.0, 0.45, 0.9};
constexpr int kDampingSteps = 36;
// Prior at the start of the trace, given as a force and a force rate, because the foot moves less on a
// steeper line. The rate is 60 N in 30 ms.
constexpr double kForce_N = 10.0, kForceRate_N_per_s = 2000.0;

}  // namespace

void UnloadingRecorder::reset() noexcept {
  kept_.pairs = 0;
  open_ = false;
  restart(0.0);
}

void UnloadingRecorder::restart(double peak_N) noexcept {
  current_.pairs = 0;
  half_ = false;
  peak_N_ = peak_N;
}

void UnloadingRecorder::close() noexcept {
  if (current_.pairs >= kLeastPairs) kept_ = current_;
  open_ = false;
  restart(0.0);
}

void UnloadingRecorder::add(const JointSample& s) noexcept {
  const double force_N = s.force_N;
  const bool elastic = std::abs(s.accel_mps2) < kImpact_mps2 && s.speed_mps <= min_speed_mps_;
  if (!elastic || force_N < kEnds * peak_N_ || force_N < kLeastForce_N) {
    if (open_) close();
    return;
  }
  open_ = true;
  if (force_N > kBegins * peak_N_) restart(std::max(peak_N_, force_N));
  const auto force = static_cast<float>(force_N), accel = static_cast<float>(s.accel_mps2);
  half_ = !half_;
  if (half_) {
    half_force_N_ = force;
    half_accel_mps2_ = accel;
    return;
  }
  if (current_.pairs == static_cast<std::int32_t>(UnloadingTrace::kPairs)) return;
  const auto i = static_cast<std::size_t>(current_.pairs++);
  current_.force_N[i] = 0.5F * (half_force_N_ + force);
  current_.accel_mps2[i] = 0.5F * (half_accel_mps2_ + accel);
}

ReloadingPosterior::ReloadingPosterior(const ProfileConfig& config, double force_noise_N,
                                       double force_scale_relative)
    : config_(config), force_noise_N_(force_noise_N), force_scale_relative_(force_scale_relative) {}

void ReloadingPosterior::restart() noexcept {
  log_likelihood_ = {};
  known_ = false;
}

double ReloadingPosterior::stiffness_N_per_m(double place) const noexcept {
  const double share = place / static_cast<double>(kGrid - 1);
  return config_.believed_stiffness_N_per_m * kLeastRatio * std::pow(kGreatestRatio / kLeastRatio, share);
}

double ReloadingPosterior::log_likelihood(const UnloadingTrace& t, double k, double c) const noexcept {
  constexpr double dt = kPair_s, h = 0.5 * dt * dt;
  // Variance of the mean of two samples.
  const double noise2 = 0.5 * force_noise_N_ * force_noise_N_;
  const double walk = 0.5 * config_.foot_accel_noise_mps2 * config_.foot_accel_noise_mps2 * dt * dt;
  double z = t.force_N[0] / k, v = 0.0, b = 0.0, sum = 0.0;
  double zz = kForce_N * kForce_N / (k * k), zv = 0.0, zb = 0.0,
         vv = kForceRate_N_per_s * kForceRate_N_per_s / (k * k), vb = 0.0,
         bb = config_.foot_accel_bias_mps2 * config_.foot_accel_bias_mps2;
  for (std::size_t i = 0; i < static_cast<std::size_t>(t.pairs); ++i) {
    if (i > 0) {
      const double a = 0.5 * (t.accel_mps2[i] + t.accel_mps2[i - 1]) - b;
      z += v * dt + a * h;
      v += a * dt;
      zz += 2.0 * dt * zv - 2.0 * h * zb + dt * dt * vv - 2.0 * dt * h * vb + h * h * bb +
            0.25 * dt * dt * walk;
      zv += dt * vv - h * vb - dt * zb - dt * dt * vb + h * dt * bb + 0.5 * dt * walk;
      zb += dt * vb - h * bb;
      vv += -2.0 * dt * vb + dt * dt * bb + walk;
      vb -= dt * bb;
    }
    const double gz = k * zz + c * zv, gv = k * zv + c * vv, gb = k * zb + c * vb;
    const double variance = k * gz + c * gv + noise2;
    const double error = t.force_N[i] - (k * z + c * v);
    sum -= 0.5 * (error * error / variance + std::log(variance));
    const double gain = error / variance;
    z += gz * gain;
    v += gv * gain;
    b += gb * gain;
    zz -= gz * gz / variance;
    zv -= gz * gv / variance;
    zb -= gz * gb / variance;
    vv -= gv * gv / variance;
    vb -= gv * gb / variance;
    bb -= gb * gb / variance;
  }
  return sum;
}

void ReloadingPosterior::add(const UnloadingTrace& trace, double foot_kg) noexcept {
  if (trace.pairs < kLeastPairs) return;
  known_ = true;
  for (std::size_t g = 0; g < kGrid; ++g) {
    const double k = stiffness_N_per_m(static_cast<double>(g));
    std::array<double, kDampingRatios.size()> each{};
    for (std::size_t j = 0; j < each.size(); ++j)
      each[j] = log_likelihood(trace, k, 2.0 * kDampingRatios[j] * std::sqrt(k * foot_kg));
    std::array<double, kDampingSteps + 1> fine{};
    for (int i = 0; i <= kDampingSteps; ++i) {
      const double x = 2.0 * i / kDampingSteps - 1.0;  // -1, 0 and 1 at the three ratios
      fine[static_cast<std::size_t>(i)] =
          each[1] + 0.5 * x * (each[2] - each[0]) + 0.5 * x * x * (each[2] - 2.0 * each[1] + each[0]);
    }
    const double best = *std::ranges::max_element(fine);
    double sum = 0.0;
    for (const double l : fine) sum += std::exp(l - best);
    log_likelihood_[g] += best + std::log(sum);
  }
}

// A good trace has a likelihood narrower than the grid. Its logarithm is smooth, so a cubic through four
// points is used.
double ReloadingPosterior::log_likelihood_at(double place) const noexcept {
  const auto first = static_cast<std::size_t>(std::clamp(place - 1.0, 0.0, static_cast<double>(kGrid - 4)));
  double sum = 0.0;
  for (std::size_t i = first; i < first + 4; ++i) {
    double weight = 1.0;
    for (std::size_t j = first; j < first + 4; ++j)
      if (j != i)
        weight *= (place - static_cast<double>(j)) / (static_cast<double>(i) - static_cast<double>(j));
    sum += weight * log_likelihood_[i];
  }
  return sum;
}

ReloadingLine ReloadingPosterior::line() const noexcept {
  if (!known_) return {};
  constexpr double kTail = 0.025;
  constexpr std::size_t kFine = 16, kPlaces = (kGrid - 1) * kFine + 1;  // 1.4 % apart
  constexpr double kStep = 1.0 / static_cast<double>(kFine);
  std::array<double, kPlaces> share{};
  for (std::size_t i = 0; i < kPlaces; ++i) share[i] = log_likelihood_at(static_cast<double>(i) * kStep);
  const double best = *std::ranges::max_element(share);
  double total = 0.0;
  for (double& s : share) total += s = std::exp(s - best);
  const auto quantile = [&](double probability) {
    double below = 0.0;
    for (std::size_t i = 0; i < kPlaces; ++i) {
      const double here = share[i] / total;
      if (below + here >= probability)
        return stiffness_N_per_m(kStep * (static_cast<double>(i) + (probability - below) / here - 0.5));
      below += here;
    }
    return stiffness_N_per_m(static_cast<double>(kGrid));
  };
  // The error of the torque constant is common to all strides and independent of their noise, so it is added
  // here.
  const double scale = 1.959964 * force_scale_relative_;
  const double middle = quantile(0.5);
  const auto beyond = [&](double end) { return std::exp(std::hypot(std::log(end / middle), scale)); };
  ReloadingLine line{middle, middle / beyond(quantile(kTail)), middle * beyond(quantile(1.0 - kTail))};
  if (line.ci95_high_N_per_m > kResolvedRatio * config_.believed_stiffness_N_per_m)
    line.ci95_high_N_per_m = std::numeric_limits<double>::infinity();
  return line;
}

}  // namespace sandhopper
