#include "tools/diagnose/plants/intruder_motion.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kFewSamples = 10;
constexpr double kAccelError = 0.01;  // of the hardest acceleration: scale and interpolation between samples

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

void smooth_jointly(IntruderMotion& m) {
  using Eigen::Matrix2d, Eigen::Vector2d;
  const std::size_t n = m.depth_m.size();
  const double dt = m.step_s;
  const Matrix2d advance{{1.0, dt}, {0.0, 1.0}};
  const Vector2d push{0.5 * dt * dt, dt};
  const double accel_sd = std::hypot(m.accel_sd_mps2, kAccelError * largest(m.accel_mps2));
  const Matrix2d process = accel_sd * accel_sd * push * push.transpose() + 1e-24 * Matrix2d::Identity();
  const Vector2d sensor{m.depth_sd_m * m.depth_sd_m, m.speed_sd_mps * m.speed_sd_mps};
  std::vector<Vector2d> before(n), after(n);
  std::vector<Matrix2d> before_cov(n), after_cov(n);
  Vector2d x{m.depth_m[0], m.speed_mps[0]};
  Matrix2d p = sensor.asDiagonal();
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) {
      x = advance * x + push * 0.5 * (m.accel_mps2[i - 1] + m.accel_mps2[i]);
      p = advance * p * advance.transpose() + process;
    }
    before[i] = x;
    before_cov[i] = p;
    if (i > 0) {
      const Matrix2d gain = p * (p + Matrix2d(sensor.asDiagonal())).inverse();
      x += gain * (Vector2d{m.depth_m[i], m.speed_mps[i]} - x);
      p = (Matrix2d::Identity() - gain) * p;
    }
    after[i] = x;
    after_cov[i] = p;
  }
  Vector2d variance = Vector2d::Zero();
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) {
      const Matrix2d back = after_cov[i] * advance.transpose() * before_cov[i + 1].inverse();
      after[i] += back * (after[i + 1] - before[i + 1]);
      after_cov[i] += back * (after_cov[i + 1] - before_cov[i + 1]) * back.transpose();
    }
    m.depth_m[i] = after[i][0];
    m.speed_mps[i] = after[i][1];
    variance += after_cov[i].diagonal() / static_cast<double>(n);
  }
  m.depth_sd_m = std::sqrt(variance[0]);
  m.speed_sd_mps = std::sqrt(variance[1]);
}

}  // namespace

IntruderMotion intruder_motion(const Samples& z, const Samples& v, const Samples& a) {
  constexpr double kSmoothing_s = 0.004, kQuantum_m = 2e-6;
  IntruderMotion m;
  m.step_s = std::clamp(median_step_s(z.time_s), 2.5e-4, 0.02);
  m.start_s = z.time_s.front();
  m.speed_from_position = v.value.size() <= kFewSamples;
  m.accel_from_position = m.speed_from_position && a.value.size() <= kFewSamples;
  const bool joined = !m.speed_from_position && a.value.size() > kFewSamples;
  const auto half = static_cast<std::size_t>(std::clamp(kSmoothing_s / m.step_s, 2.0, 8.0));
  const auto count = static_cast<std::size_t>((z.time_s.back() - z.time_s.front()) / m.step_s) + 1;
  const auto put = [&](std::vector<double>& into, const Samples& samples) {
    into = on_grid(samples, m.start_s, m.step_s, count, false).values;
    for (double& value : into) value = -value;
  };
  const double noise_m = fluctuation_rms(z);
  const Smoothed at = smooth(z, half);
  put(m.depth_m, {z.time_s, noise_m > kQuantum_m && !joined ? at.value : z.value});
  put(m.speed_mps, m.speed_from_position ? Samples{z.time_s, at.rate} : v);
  put(m.accel_mps2, a.value.size() > kFewSamples ? a
                    : m.speed_from_position      ? Samples{z.time_s, smooth(z, 2 * half).curvature}
                                                 : Samples{v.time_s, smooth(v, half).rate});
  m.depth_sd_m = std::max(noise_m, 1e-7);
  m.speed_sd_mps = std::max(
      m.speed_from_position ? noise_m / (m.step_s * static_cast<double>(half)) : fluctuation_rms(v), 1e-7);
  m.accel_sd_mps2 = a.value.size() > kFewSamples ? std::max(fluctuation_rms(a), 1e-6) : 0.0;
  if (joined)
    smooth_jointly(m);
  else if (noise_m > kQuantum_m)
    m.depth_sd_m /= std::sqrt(static_cast<double>(half));
  return m;
}

}  // namespace sandhopper::diagnose
