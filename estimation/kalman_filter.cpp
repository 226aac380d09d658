#include "estimation/kalman_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {

KalmanFilter::KalmanFilter(const KalmanConfig& config) noexcept : config_(config) {}

void KalmanFilter::reset(const BodyFootState& state) noexcept {
  x_ << state.body_z_m, state.body_velocity_mps, state.foot_z_m, state.foot_velocity_mps;
  const double z = config_.initial_height_noise_m * config_.initial_height_noise_m;
  const double v = config_.initial_speed_noise_mps * config_.initial_speed_noise_mps;
  p_.setZero();
  p_.diagonal() << z, v, z, v;
  filled_ = 0;
}

void KalmanFilter::predict(const BodyFootAccel& accel, double dt_s) noexcept {
  const double half = dt_s * dt_s / 2.0;
  x_(0) += dt_s * x_(1) + half * accel.body_mps2;
  x_(1) += dt_s * accel.body_mps2;
  x_(2) += dt_s * x_(3) + half * accel.foot_mps2;
  x_(3) += dt_s * accel.foot_mps2;

  // P <- A P A^T + Q in place. A = I + dt on the two superdiagonal elements that couple height and speed.
  p_.row(0) += dt_s * p_.row(1);
  p_.row(2) += dt_s * p_.row(3);
  p_.col(0) += dt_s * p_.col(1);
  p_.col(2) += dt_s * p_.col(3);
  const double qb = config_.body_accel_noise_mps2 * config_.body_accel_noise_mps2;
  // At the end of its range the accelerometer may miss as much as it reads. Use the reading as its noise, so
  // that the leg's encoders determine the foot's speed.
  const double foot_noise = accel.foot_at_range ? std::abs(accel.foot_mps2) : config_.foot_accel_noise_mps2;
  const double qf = foot_noise * foot_noise;
  const auto add_noise = [&](Eigen::Index i, double q) {
    p_(i, i) += q * half * half;
    p_(i, i + 1) += q * half * dt_s;
    p_(i + 1, i) += q * half * dt_s;
    p_(i + 1, i + 1) += q * dt_s * dt_s;
  };
  add_noise(0, qb);
  add_noise(2, qf);

  newest_ = (newest_ + 1) % kHistory;
  history_[newest_] = {accel, dt_s};
  filled_ = std::min(filled_ + 1, kHistory);
}

KalmanFilter::Lookback KalmanFilter::look_back(double age_s) const noexcept {
  Lookback back{0.0, {0.0, 0.0}, {0.0, 0.0}};
  double remaining = std::max(age_s, 0.0);
  for (std::size_t i = 0; i < filled_ && remaining > 0.0; ++i) {
    const Step& step = history_[(newest_ + kHistory - i) % kHistory];
    const double dt = std::min(step.dt_s, remaining);
    const std::array<double, 2> accel{step.accel.body_mps2, step.accel.foot_mps2};
    for (std::size_t m = 0; m < 2; ++m) {
      // One step further back from age s: z(t-s-dt) = z(t-s) - dt v(t-s) + accel dt^2/2 with v(t-s) = v(t) -
      // speed.
      back.displacement_m[m] += dt * back.speed_mps[m] + accel[m] * dt * dt / 2.0;
      back.speed_mps[m] += accel[m] * dt;
    }
    back.age_s += dt;
    remaining -= dt;
  }
  return back;
}

BodyFootState KalmanFilter::state() const noexcept { return {x_(0), x_(1), x_(2), x_(3)}; }

BodyFootState KalmanFilter::state_before(double age_s) const noexcept {
  const auto back = look_back(age_s);
  return {x_(0) - back.age_s * x_(1) + back.displacement_m[0], x_(1) - back.speed_mps[0],
          x_(2) - back.age_s * x_(3) + back.displacement_m[1], x_(3) - back.speed_mps[1]};
}

Innovation KalmanFilter::update(const Eigen::Vector4d& row, double residual, double noise,
                                double gate_sigma) noexcept {
  const Eigen::Vector4d ph = p_ * row;
  const double s = row.dot(ph) + noise * noise;
  const double squared = residual * residual / s;
  if (!(squared <= gate_sigma * gate_sigma)) return {residual, squared, true};
  const Eigen::Vector4d gain = ph / s;
  x_ += gain * residual;
  p_ -= gain * ph.transpose();
  p_ = (0.5 * (p_ + p_.transpose())).eval();
  return {residual, squared, false};
}

namespace {
constexpr double kNoGate = std::numeric_limits<double>::infinity();
}

Innovation KalmanFilter::update_body_height(double height_m, double age_s) noexcept {
  const auto back = look_back(age_s);
  const Eigen::Vector4d row(1.0, -back.age_s, 0.0, 0.0);
  return update(row, height_m - (row.dot(x_) + back.displacement_m[0]), config_.tof_noise_m,
                config_.tof_gate_sigma);
}

Innovation KalmanFilter::update_leg_length(double distance_m, double age_s) noexcept {
  const auto back = look_back(age_s);
  const Eigen::Vector4d row(1.0, -back.age_s, -1.0, back.age_s);
  const double known = back.displacement_m[0] - back.displacement_m[1];
  return update(row, distance_m - (row.dot(x_) + known), config_.leg_length_noise_m, kNoGate);
}

Innovation KalmanFilter::update_leg_rate(double rate_mps, double age_s) noexcept {
  const auto back = look_back(age_s);
  const Eigen::Vector4d row(0.0, 1.0, 0.0, -1.0);
  const double known = back.speed_mps[1] - back.speed_mps[0];
  return update(row, rate_mps - (row.dot(x_) + known), config_.leg_rate_noise_mps, kNoGate);
}

}  // namespace sandhopper
