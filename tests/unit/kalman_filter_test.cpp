#include "estimation/kalman_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "estimation/momentum_observer.hpp"

namespace sandhopper {
namespace {

struct Model {
  Eigen::Matrix4d a = Eigen::Matrix4d::Identity();
  Eigen::Matrix<double, 4, 2> b = Eigen::Matrix<double, 4, 2>::Zero();
  explicit Model(double t) {
    a(0, 1) = a(2, 3) = t;
    b(0, 0) = b(2, 1) = t * t / 2;
    b(1, 0) = b(3, 1) = t;
  }
};

TEST(KalmanFilter, EqualsTheTextbookMatricesWhenNothingIsOld) {
  const KalmanConfig c;
  const double t = 1e-3;
  const Model m(t);
  KalmanFilter filter(c);
  filter.reset({0.5, 0.1, 0.06, -0.2});
  Eigen::Vector4d x(0.5, 0.1, 0.06, -0.2);
  Eigen::Matrix4d p = filter.covariance();
  const Eigen::Vector2d q(c.body_accel_noise_mps2 * c.body_accel_noise_mps2,
                          c.foot_accel_noise_mps2 * c.foot_accel_noise_mps2);
  Eigen::Matrix<double, 3, 4> h;
  h << 1, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0, -1;
  const Eigen::Vector3d r(c.tof_noise_m, c.leg_length_noise_m, c.leg_rate_noise_mps);
  for (int k = 0; k < 50; ++k) {
    const Eigen::Vector2d u(-9.0 + 0.1 * k, 3.0 - 0.2 * k);
    const Eigen::Vector3d y(0.5, 0.43, 0.25);
    filter.predict({u(0), u(1)}, t);
    filter.update_body_height(y(0), 0.0);
    filter.update_leg_length(y(1), 0.0);
    filter.update_leg_rate(y(2), 0.0);
    x = m.a * x + m.b * u;
    p = m.a * p * m.a.transpose() + m.b * q.asDiagonal() * m.b.transpose();
    const Eigen::Matrix3d s =
        h * p * h.transpose() + Eigen::Matrix3d(r.array().square().matrix().asDiagonal());
    const Eigen::Matrix<double, 4, 3> gain = p * h.transpose() * s.inverse();
    x += gain * (y - h * x);
    p = (Eigen::Matrix4d::Identity() - gain * h) * p;
  }
  const auto got = filter.state();
  EXPECT_NEAR(got.body_z_m, x(0), 1e-9);
  EXPECT_NEAR(got.body_velocity_mps, x(1), 1e-9);
  EXPECT_NEAR(got.foot_z_m, x(2), 1e-9);
  EXPECT_NEAR(got.foot_velocity_mps, x(3), 1e-9);
  EXPECT_LT((filter.covariance() - p).cwiseAbs().maxCoeff(), 1e-10);
}

// A foot that is stopped with twice the range of its accelerometer.
double speed_error_after_a_blow(bool told) {
  KalmanFilter filter{KalmanConfig{}};
  filter.reset({0.5, 0.0, 0.06, -1.0});
  const double t = 1e-3;
  double foot_z = 0.06, foot_v = -1.0;
  for (int k = 0; k < 30; ++k) {
    const bool blow = k == 20 || k == 21;
    const double truth = blow ? 300.0 : 0.0;
    foot_z += foot_v * t + 0.5 * truth * t * t;
    foot_v += truth * t;
    filter.predict({0.0, blow ? 147.0 : 0.0, blow && told}, t);
    filter.update_body_height(0.5, 0.0);
    filter.update_leg_length(0.5 - foot_z, 0.0);
    filter.update_leg_rate(-foot_v, 0.0);
    if (k == 23) return std::abs(filter.state().foot_velocity_mps - foot_v);
  }
  return 0.0;
}

TEST(KalmanFilter, WhereAnAccelerometerIsAtItsRangeTheEncodersTellTheSpeed) {
  EXPECT_LT(speed_error_after_a_blow(true), 0.03);
  EXPECT_GT(speed_error_after_a_blow(false), 0.1);
}

TEST(KalmanFilter, StateBeforeInvertsThePredictionsExactly) {
  KalmanFilter filter(KalmanConfig{});
  filter.reset({0.5, 0.1, 0.06, -0.2});
  std::vector<BodyFootState> past;
  for (int k = 0; k < 10; ++k) {
    past.push_back(filter.state());
    filter.predict({std::sin(k), -9.0 + 3.0 * k}, 1e-3);
  }
  for (std::size_t back = 1; back <= 10; ++back) {
    const auto s = filter.state_before(1e-3 * static_cast<double>(back));
    EXPECT_NEAR(s.body_z_m, past[10 - back].body_z_m, 1e-14);
    EXPECT_NEAR(s.foot_velocity_mps, past[10 - back].foot_velocity_mps, 1e-14);
    EXPECT_NEAR(s.foot_z_m, past[10 - back].foot_z_m, 1e-14);
  }
}

// A falling body measured 4 ms late. If its age is known, the reading is as good as a prompt one; otherwise
// it is wrong by v t.
TEST(KalmanFilter, ALateReadingIsUsedAtItsOwnAge) {
  const auto final_error = [](bool tell_age) {
    KalmanFilter filter(KalmanConfig{});
    filter.reset({1.0, 0.0, 0.6, 0.0});
    const double g = 9.81, t = 1e-3;
    for (int k = 1; k <= 400; ++k) {
      filter.predict({-g, -g}, t);
      const double then = (k - 4) * t;
      filter.update_body_height(1.0 - g * then * then / 2 * (then > 0), tell_age ? 4 * t : 0.0);
    }
    return filter.state().body_z_m - (1.0 - g * 0.4 * 0.4 / 2);
  };
  EXPECT_LT(std::abs(final_error(true)), 1e-5);
  EXPECT_GT(std::abs(final_error(false)), 5e-3);
}

TEST(KalmanFilter, IsObservableOnlyWithTheHeightSensor) {
  const Model m(1e-3);
  Eigen::Matrix<double, 3, 4> h;
  h << 1, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0, -1;
  const auto rank = [&](const Eigen::MatrixXd& rows) {
    Eigen::MatrixXd o(4 * rows.rows(), 4);
    Eigen::Matrix4d power = Eigen::Matrix4d::Identity();
    for (int i = 0; i < 4; ++i, power = power * m.a)
      o.middleRows(i * rows.rows(), rows.rows()) = rows * power;
    return Eigen::FullPivLU<Eigen::MatrixXd>(o).setThreshold(1e-9).rank();
  };
  EXPECT_EQ(rank(h), 4);
  EXPECT_EQ(rank(h.bottomRows(2)), 2);
}

TEST(KalmanFilter, NormalisedInnovationsHaveTheirStatedSizeWhenTheModelIsTrue) {
  const KalmanConfig c;
  std::mt19937_64 rng(1);
  std::normal_distribution<double> n;
  KalmanFilter filter(c);
  filter.reset({0.5, 0.0, 0.06, 0.0});
  Eigen::Vector4d x(0.5 + 0.01 * n(rng), 0.01 * n(rng), 0.06 + 0.01 * n(rng), 0.01 * n(rng));
  const Model m(1e-3);
  double sum = 0.0;
  const int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    const Eigen::Vector2d u(2 * std::sin(0.01 * k), -std::cos(0.02 * k));
    x = m.a * x +
        m.b * (u + Eigen::Vector2d(c.body_accel_noise_mps2 * n(rng), c.foot_accel_noise_mps2 * n(rng)));
    filter.predict({u(0), u(1)}, 1e-3);
    sum += filter.update_body_height(x(0) + c.tof_noise_m * n(rng), 0.0).normalised_squared;
    sum += filter.update_leg_length(x(0) - x(2) + c.leg_length_noise_m * n(rng), 0.0).normalised_squared;
    sum += filter.update_leg_rate(x(1) - x(3) + c.leg_rate_noise_mps * n(rng), 0.0).normalised_squared;
  }
  const double mean = sum / (3 * steps);
  EXPECT_NEAR(mean, 1.0, 4.0 * std::sqrt(2.0 / (3 * steps)));
}

TEST(KalmanFilter, AWildHeightReadingIsNotUsed) {
  KalmanFilter filter(KalmanConfig{});
  filter.reset({0.5, 0.0, 0.06, 0.0});
  filter.predict({0.0, 0.0}, 1e-3);
  EXPECT_TRUE(filter.update_body_height(2.0, 0.0).gated);
  EXPECT_EQ(filter.state().body_z_m, 0.5);
}

TEST(MomentumObserver, AStepOfForceAppearsWithTheGainsTimeConstant) {
  const double gain = 400.0, t = 1e-4, force = 30.0;
  MomentumObserver observer(gain);
  observer.reset(0.0);
  double p = 0.0;
  for (int k = 1; k <= 25; ++k) observer.update(p += force * t, 0.0, t);  // 25 x 0.1 ms = 1/gain
  EXPECT_NEAR(observer.force_N(), force * (1 - std::exp(-1.0)), 1e-9);
}

TEST(MomentumObserver, TheDiscretisationDoesNotDependOnTheStep) {
  for (const double t : {1e-4, 1e-3, 5e-3}) {
    MomentumObserver observer(200.0);
    observer.reset(0.0);
    const int n = static_cast<int>(std::lround(0.02 / t));
    for (int k = 1; k <= n; ++k) observer.update(12.0 * t * k, -3.0, t);
    EXPECT_NEAR(observer.force_N(), 15.0 * (1 - std::exp(-200.0 * 0.02)), 1e-9) << t;
  }
}

}  // namespace
}  // namespace sandhopper
