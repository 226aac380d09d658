#include "estimation/motion_smoother.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kUnmeasuredAccel_mps2 = 30.0;  // process noise of one step if there is no accelerometer
constexpr double kStartSpeed_mps = 3.0;

struct Step {
  Vector predicted, filtered;
  Matrix predicted_covariance, filtered_covariance, transition;
};

Matrix transition_over(double step_s) {
  Matrix a = Matrix::Identity();
  a(0, 1) = step_s;
  a(0, 2) = -0.5 * step_s * step_s;
  a(1, 2) = -step_s;
  return a;
}

std::vector<double> held(std::span<const double> values, std::size_t size) {
  std::vector<double> out(size, 0.0);
  double last = 0.0;
  bool any = false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) {
      last = values[i];
      if (!any) std::fill(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(i), last);
      any = true;
    }
    out[i] = last;
  }
  return out;
}

class Smoother {
 public:
  Smoother(std::span<const double> t_s, std::span<const double> position_m,
           std::span<const double> accel_mps2, const MotionNoise& noise)
      : t_s_(t_s),
        position_m_(position_m),
        accel_mps2_(held(accel_mps2, t_s.size())),
        measured_(std::any_of(accel_mps2.begin(), accel_mps2.end(), [](double a) { return !std::isnan(a); })),
        noise_(noise),
        steps_(t_s.size()) {}

  SmoothMotion run(double first_position_m) {
    Vector x(first_position_m, 0.0, 0.0);
    const double start_m = 0.1;
    Matrix p =
        Vector(start_m * start_m, kStartSpeed_mps * kStartSpeed_mps, noise_.bias_mps2 * noise_.bias_mps2)
            .asDiagonal();
    for (std::size_t i = 0; i < t_s_.size(); ++i) {
      if (i > 0) predict(i, x, p);
      steps_[i].predicted = x;
      steps_[i].predicted_covariance = p;
      if (!std::isnan(position_m_[i])) correct(position_m_[i], x, p);
      steps_[i].filtered = x;
      steps_[i].filtered_covariance = p;
    }
    return backward();
  }

 private:
  void predict(std::size_t i, Vector& x, Matrix& p) {
    const double step_s = t_s_[i] - t_s_[i - 1];
    const Matrix a = transition_over(step_s);
    const Vector input(0.5 * step_s * step_s, step_s, 0.0);
    const double accel = measured_ ? noise_.accel_mps2 : kUnmeasuredAccel_mps2;
    x = a * x + input * (0.5 * (accel_mps2_[i] + accel_mps2_[i - 1]));
    p = a * p * a.transpose() + accel * accel * input * input.transpose();
    p(2, 2) += noise_.bias_walk_mps2 * noise_.bias_walk_mps2 * step_s;
    steps_[i].transition = a;
  }

  void correct(double measured_m, Vector& x, Matrix& p) const {
    const double innovation_variance = p(0, 0) + noise_.position_m * noise_.position_m;
    const Vector gain = p.col(0) / innovation_variance;
    x += gain * (measured_m - x(0));
    p -= gain * p.row(0).eval();
  }

  SmoothMotion backward() {
    const std::size_t n = t_s_.size();
    SmoothMotion out{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
    Vector x = steps_.back().filtered;
    for (std::size_t i = n; i-- > 0;) {
      if (i + 1 < n) {
        const auto& next = steps_[i + 1];
        const Matrix gain =
            steps_[i].filtered_covariance * next.transition.transpose() * next.predicted_covariance.inverse();
        x = steps_[i].filtered + gain * (x - next.predicted);
      }
      out.position_m[i] = x(0);
      out.velocity_mps[i] = x(1);
      out.accel_mps2[i] = accel_mps2_[i] - x(2);
    }
    if (!measured_) differentiate(out);
    return out;
  }

  // Without an accelerometer the acceleration is the slope of the smoothed velocity.
  void differentiate(SmoothMotion& out) const {
    const std::size_t n = t_s_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, n - 1);
      out.accel_mps2[i] =
          after > before ? (out.velocity_mps[after] - out.velocity_mps[before]) / (t_s_[after] - t_s_[before])
                         : 0.0;
    }
  }

  std::span<const double> t_s_, position_m_;
  std::vector<double> accel_mps2_;
  bool measured_;
  MotionNoise noise_;
  std::vector<Step> steps_;
};

}  // namespace

SmoothMotion smooth_motion(std::span<const double> t_s, std::span<const double> position_m,
                           std::span<const double> accel_mps2, const MotionNoise& noise) {
  std::size_t known = 0, first = 0;
  for (std::size_t i = position_m.size(); i-- > 0;)
    if (!std::isnan(position_m[i])) {
      ++known;
      first = i;
    }
  if (known < 2) {
    const std::vector<double> none(t_s.size(), kUnknown);
    return {none, none, none};
  }
  return Smoother(t_s, position_m, accel_mps2, noise).run(position_m[first]);
}

}  // namespace sandhopper
