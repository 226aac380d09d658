#include "tools/diagnose/plants/intruder/intruder_motion.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kFewSamples = 10;  // a channel with no more samples counts as not recorded
constexpr double kAccelError = 0.01;     // relative error of an acceleration: the sensor's scale

// Points of a grid from the first to the last time, also if the rounding of times makes the last step a
// little short.
std::size_t points_of_grid(const std::vector<double>& time_s, double step_s) {
  constexpr double kRounding = 1e-6;  // of a step
  return static_cast<std::size_t>((time_s.back() - time_s.front()) / step_s + kRounding) + 1;
}

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

// Per grid point, true if the quantity was sampled there; false inside a gap.
std::vector<bool> sampled(const Samples& samples, const IntruderMotion& m) {
  std::vector<bool> known(m.depth_m.size(), false);
  std::size_t next = 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const double t = m.start_s + m.step_s * static_cast<double>(i);
    while (next < samples.time_s.size() && samples.time_s[next] < t - 0.5 * m.step_s) ++next;
    const bool here = next < samples.time_s.size() && samples.time_s[next] < t + 0.5 * m.step_s;
    const bool between = next > 0 && next < samples.time_s.size() &&
                         samples.time_s[next] - samples.time_s[next - 1] < kGapSteps * m.step_s;
    known[i] = here || between;
  }
  return known;
}

// Nearest sample to each step of the grid: its value, down positive, and its time after the step.
struct AtStep {
  std::vector<double> value, late_s;
  std::vector<bool> known;
};
AtStep at_steps(const Samples& samples, const IntruderMotion& m) {
  const std::size_t n = m.depth_m.size();
  AtStep at{std::vector<double>(n), std::vector<double>(n), std::vector<bool>(n, false)};
  for (std::size_t k = 0; k < samples.time_s.size(); ++k) {
    const double place = std::round((samples.time_s[k] - m.start_s) / m.step_s);
    if (place < 0.0 || place >= static_cast<double>(n)) continue;
    const auto i = static_cast<std::size_t>(place);
    const double late_s = samples.time_s[k] - m.start_s - m.step_s * place;
    if (at.known[i] && std::abs(late_s) >= std::abs(at.late_s[i])) continue;
    at.known[i] = true;
    at.value[i] = -samples.value[k];
    at.late_s[i] = late_s;
  }
  return at;
}

// Kalman filter forward and Rauch-Tung-Striebel smoother backward, with the state
//   x = (depth, speed, offset b of the accelerometer, its delay l).
class JointSmoother {
 public:
  JointSmoother(const IntruderMotion& m, const Samples& z, const Samples& v, const Samples& a)
      : m_(m),
        depth_(at_steps(z, m)),
        speed_(at_steps(v, m)),
        accel_known_(sampled(a, m)),
        hardest_mps2_(largest(m.accel_mps2)),
        accel_step_s_(median_step_s(a.time_s)) {}

  // Replaces the recorded motion by the smoothed one, and sets its standard deviations.
  void smooth(IntruderMotion& out) {
    forward();
    back();
    out.accel_mps2 = corrected_accel();
    Vector variance = Vector::Zero();
    for (std::size_t i = 0; i < after_.size(); ++i) {
      out.depth_m[i] = after_[i][0];
      out.speed_mps[i] = after_[i][1];
      variance += after_cov_[i].diagonal() / static_cast<double>(after_.size());
    }
    out.depth_sd_m = std::sqrt(variance[0]);
    out.speed_sd_mps = std::sqrt(variance[1]);
  }

 private:
  using Vector = Eigen::Vector4d;
  using Matrix = Eigen::Matrix4d;

  // Change of the state by an acceleration of 1 over one step.
  Vector push() const { return {0.5 * m_.step_s * m_.step_s, m_.step_s, 0.0, 0.0}; }
  double change(std::size_t i) const { return m_.accel_mps2[i] - m_.accel_mps2[i - 1]; }
  // State transition from step i - 1 to i.
  Matrix advance(std::size_t i) const {
    Matrix f = Matrix::Identity();
    f(0, 1) = m_.step_s;
    f.col(2) -= push();
    f.col(3) += push() * change(i) / m_.step_s;
    return f;
  }
  // Standard deviation of the mean acceleration from step i - 1 to i; large inside a gap. The acceleration
  // may jump at any time between the steps, so its mean is uniform between both values.
  double accel_sd(std::size_t i) const {
    if (!accel_known_[i]) return hardest_mps2_;
    return std::hypot(m_.accel_sd_mps2[i], kAccelError * m_.accel_mps2[i], change(i) / std::sqrt(12.0));
  }
  // Kalman update by a reading `seen` of depth or speed, which is `of` times the state.
  static void take(Vector& x, Matrix& p, const Eigen::RowVector4d& of, double seen, double variance) {
    const Vector gain = p * of.transpose() / (of.dot(p * of.transpose()) + variance);
    x += gain * (seen - of.dot(x));
    p = (Matrix::Identity() - gain * of) * p;
  }

  void forward() {
    const double depth_variance = m_.depth_sd_m * m_.depth_sd_m;
    const double speed_variance = m_.speed_sd_mps * m_.speed_sd_mps;
    const double within_a_step_mps = hardest_mps2_ * m_.step_s;
    Vector x{m_.depth_m[0], m_.speed_mps[0], 0.0, 0.0};
    Matrix p = Vector{depth_variance, within_a_step_mps * within_a_step_mps + speed_variance,
                      hardest_mps2_ * hardest_mps2_, accel_step_s_ * accel_step_s_}
                   .asDiagonal();
    for (std::size_t i = 0; i < m_.depth_m.size(); ++i) {
      if (i > 0) {
        const Matrix f = advance(i);
        const double sd = accel_sd(i);
        x = f * x + push() * 0.5 * (m_.accel_mps2[i - 1] + m_.accel_mps2[i]);
        p = f * p * f.transpose() + sd * sd * push() * push().transpose() + 1e-24 * Matrix::Identity();
      }
      before_.push_back(x);
      before_cov_.push_back(p);
      if (i > 0 && depth_.known[i])
        take(x, p, {1.0, depth_.late_s[i], 0.0, 0.0}, depth_.value[i], depth_variance);
      if (i > 0 && speed_.known[i])
        take(x, p, {0.0, 1.0, 0.0, 0.0}, speed_.value[i] - m_.accel_mps2[i] * speed_.late_s[i],
             speed_variance);
      after_.push_back(x);
      after_cov_.push_back(p);
    }
  }

  void back() {
    for (std::size_t i = after_.size() - 1; i-- > 0;) {
      const Matrix gain = after_cov_[i] * advance(i + 1).transpose() * before_cov_[i + 1].inverse();
      after_[i] += gain * (after_[i + 1] - before_[i + 1]);
      after_cov_[i] += gain * (after_cov_[i + 1] - before_cov_[i + 1]) * gain.transpose();
    }
  }

  // The acceleration without the accelerometer's errors, a - b + l a'.
  std::vector<double> corrected_accel() const {
    const std::size_t n = after_.size();
    std::vector<double> accel(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t left = i > 0 ? i - 1 : 0, right = std::min(i + 1, n - 1);
      const double rate =
          (m_.accel_mps2[right] - m_.accel_mps2[left]) / (m_.step_s * static_cast<double>(right - left));
      accel[i] = m_.accel_mps2[i] - after_[i][2] + after_[i][3] * rate;
    }
    return accel;
  }

  const IntruderMotion m_;
  const AtStep depth_, speed_;
  const std::vector<bool> accel_known_;
  const double hardest_mps2_, accel_step_s_;
  std::vector<Vector> before_, after_;
  std::vector<Matrix> before_cov_, after_cov_;
};

// Refines the grid for a fast foot, which meets the bed between two rows. Interpolation by cubics (Hermite).
void refine(IntruderMotion& m) {
  constexpr double kFarthest_m = 1.5e-4;  // largest motion within one step of the finer grid
  constexpr std::size_t kMostParts = 8;   // of one step
  const auto parts = std::clamp<std::size_t>(
      static_cast<std::size_t>(m.step_s * largest(m.speed_mps) / kFarthest_m + 1.0), 1, kMostParts);
  const std::size_t n = m.depth_m.size();
  if (parts == 1 || n < 2) return;
  const auto joined = [&](const std::vector<double>& value, const std::vector<double>* rate) {
    std::vector<double> fine;
    fine.reserve((n - 1) * parts + 1);
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t k = 0; k < parts; ++k) {
        const double u = static_cast<double>(k) / static_cast<double>(parts), w = 1.0 - u;
        double x = w * value[i] + u * value[i + 1];
        if (rate != nullptr) {
          const double mean = (value[i + 1] - value[i]) / m.step_s;
          x += u * w * m.step_s * (w * ((*rate)[i] - mean) - u * ((*rate)[i + 1] - mean));
        }
        fine.push_back(x);
      }
    fine.push_back(value[n - 1]);
    return fine;
  };
  m.depth_m = joined(m.depth_m, &m.speed_mps);
  m.speed_mps = joined(m.speed_mps, &m.accel_mps2);
  m.accel_mps2 = joined(m.accel_mps2, nullptr);
  m.accel_sd_mps2 = joined(m.accel_sd_mps2, nullptr);
  m.step_s /= static_cast<double>(parts);
}

constexpr double kClear = 4.0;                             // least significance, in standard errors
constexpr double kLeastLate_s = 1e-4, kLeastDrift = 1e-4;  // a smaller error changes no force visibly

std::vector<double> at_times(const std::vector<double>& time_s, const std::vector<double>& values,
                             const std::vector<double>& wanted_s) {
  const double step_s = median_step_s(time_s);
  const std::size_t count = points_of_grid(time_s, step_s);
  const Signal signal = on_grid({time_s, values}, time_s.front(), step_s, count, false);
  std::vector<double> out;
  for (const double t : wanted_s) out.push_back(signal.at(t));
  return out;
}

// Delay of a position and drift of its clock, with standard errors.
struct OutOfTime {
  double late_s, drift, late_se_s, drift_se;
};
std::optional<OutOfTime> out_of_time(const Samples& z, const Samples& v, const Samples& a) {
  constexpr std::size_t kOfRate = 5, kOfCurvature = 15;   // samples of `other` to each side
  constexpr std::size_t kLeastRows = 50, kLeastHalf = 3;  // samples of a channel; samples to each side
  const bool by_speed = z.time_s == v.time_s;
  const Samples& recorded = by_speed ? v : a;
  if (z.time_s.size() < kLeastRows || recorded.time_s.size() < kLeastRows) return std::nullopt;
  const std::size_t half_other = by_speed ? kOfRate : kOfCurvature;
  // Both are smoothed over the same time, also if the position has fewer samples.
  const double slower = median_step_s(z.time_s) / median_step_s(recorded.time_s);
  const auto half = std::max(
      kLeastHalf,
      static_cast<std::size_t>(std::lround(static_cast<double>(half_other) / std::max(slower, 1.0))));
  const auto position = smooth(z, half);
  Smoothed other = smooth(recorded, half_other);
  if (z.time_s != recorded.time_s) {
    other.value = at_times(recorded.time_s, other.value, z.time_s);
    other.rate = at_times(recorded.time_s, other.rate, z.time_s);
  }
  const auto& derived = by_speed ? position.rate : position.curvature;
  const double order = by_speed ? 1.0 : 2.0;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  Eigen::Vector2d score = Eigen::Vector2d::Zero();
  double squares = 0.0;
  for (std::size_t i = half; i + half < z.time_s.size(); ++i) {
    const double rate = other.rate[i], apart = derived[i] - other.value[i];
    const Eigen::Vector2d x(-rate, -(order * other.value[i] + z.time_s[i] * rate));
    information += x * x.transpose();
    score += x * apart;
    squares += apart * apart;
  }
  const Eigen::Matrix2d inverse = information.inverse();
  const Eigen::Vector2d found = inverse * score;
  if (!found.allFinite()) return std::nullopt;
  // The rows of one local parabola count as one observation, because they are correlated.
  const double variance = std::max(0.0, squares - found.dot(score)) * static_cast<double>(2 * half + 1) /
                          static_cast<double>(z.time_s.size());
  const Eigen::Vector2d se = (inverse.diagonal() * variance).cwiseMax(0.0).cwiseSqrt();
  return OutOfTime{found[0], found[1], se[0], se[1]};
}

}  // namespace

IntruderMotion intruder_motion(const Samples& z, const Samples& v, const Samples& a) {
  // Time to each side over which a motion is smoothed; noise below which a depth is used as it is.
  constexpr double kSmoothing_s = 0.004, kQuantum_m = 2e-6;
  IntruderMotion m;
  m.start_s = z.time_s.front();
  // A late position does not belong to the same motion, so the sensors are not joined.
  const auto apart = out_of_time(z, v, a);
  const bool late = apart && (std::abs(apart->late_s) > std::max(kLeastLate_s, kClear * apart->late_se_s) ||
                              std::abs(apart->drift) > std::max(kLeastDrift, kClear * apart->drift_se));
  const bool joined = a.value.size() > kFewSamples && !late;
  m.speed_from_position = v.value.size() <= kFewSamples && !joined;
  m.accel_from_position = m.speed_from_position && a.value.size() <= kFewSamples;
  const double depth_step_s = median_step_s(z.time_s);
  m.step_s =
      std::clamp(joined ? std::min(depth_step_s, median_step_s(a.time_s)) : depth_step_s, 2.5e-4, 0.02);
  const auto half = static_cast<std::size_t>(std::clamp(kSmoothing_s / m.step_s, 2.0, 8.0));
  const std::size_t count = points_of_grid(z.time_s, m.step_s);
  const auto put = [&](std::vector<double>& into, const Samples& samples) {
    into = on_grid(samples, m.start_s, m.step_s, count, false).values;
    for (double& value : into) value = -value;
  };
  const double noise_m = fluctuation_rms(z);
  const Smoothed at = smooth(z, half);
  put(m.depth_m, {z.time_s, noise_m > kQuantum_m && !joined ? at.value : z.value});
  put(m.speed_mps, m.speed_from_position ? Samples{z.time_s, at.rate} : v);
  if (a.value.size() > kFewSamples) {
    put(m.accel_mps2, a);
    m.accel_sd_mps2.assign(count, std::max(fluctuation_rms(a), 1e-6));
  } else {
    const auto derived = [&](std::size_t widths) {
      return m.speed_from_position ? Samples{z.time_s, smooth(z, 2 * widths * half).curvature}
                                   : Samples{v.time_s, smooth(v, widths * half).rate};
    };
    put(m.accel_mps2, derived(1));
    put(m.accel_sd_mps2, derived(2));
    const double n = static_cast<double>(2 * half * (m.speed_from_position ? 2 : 1) + 1);
    const double noise = m.speed_from_position
                             ? noise_m * std::sqrt(720.0 / std::pow(n, 5)) / (m.step_s * m.step_s)
                             : fluctuation_rms(v) * std::sqrt(12.0 / std::pow(n, 3)) / m.step_s;
    for (std::size_t i = 0; i < count; ++i)
      m.accel_sd_mps2[i] = std::hypot(noise, m.accel_sd_mps2[i] - m.accel_mps2[i]);
  }
  m.depth_sd_m = std::max(noise_m, 1e-7);
  m.speed_sd_mps = std::max(
      m.speed_from_position ? noise_m / (m.step_s * static_cast<double>(half)) : fluctuation_rms(v), 1e-7);
  if (joined)
    JointSmoother(m, z, v, a).smooth(m);
  else if (noise_m > kQuantum_m)
    m.depth_sd_m /= std::sqrt(static_cast<double>(half));
  refine(m);
  return m;
}

bool position_is_out_of_time(const std::vector<Trial>& trials) {
  constexpr std::size_t kLeastTrials = 3;  // for a scatter between trials
  std::vector<double> late_s, drift;
  for (const auto& trial : trials)
    if (const auto apart = out_of_time(samples_of(trial, "foot_z_m"), samples_of(trial, "foot_velocity_mps"),
                                       samples_of(trial, "foot_accel_mps2"))) {
      late_s.push_back(apart->late_s);
      drift.push_back(apart->drift);
    }
  const auto clear = [](const std::vector<double>& of_trial, double least) {
    const auto n = static_cast<double>(of_trial.size());
    double sum = 0.0, squares = 0.0;
    for (const double x : of_trial) sum += x, squares += x * x;
    const double mean = sum / n, variance = std::max(0.0, (squares - n * mean * mean) / (n - 1.0));
    return std::abs(mean) > std::max(least, kClear * std::sqrt(variance / n));
  };
  return late_s.size() >= kLeastTrials && (clear(late_s, kLeastLate_s) || clear(drift, kLeastDrift));
}

}  // namespace sandhopper::diagnose
