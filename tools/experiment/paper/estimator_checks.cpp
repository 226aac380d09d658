#include "tools/experiment/paper/estimator_checks.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "estimation/momentum_observer.hpp"
#include "tools/experiment/nominal_stride.hpp"
#include "tools/experiment/paper/hop_trial.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

// p = M_f v_f and psi at one instant of a frictionless hop, with the torque held since then.
struct MomentumTerms {
  double momentum_kg_mps;
  double psi_N;
};

MomentumTerms momentum_terms(const Leg& leg, const PlantTruth& truth, double torque_Nm, double gravity_mps2) {
  const auto d = leg.dynamics(truth.leg_angle_rad);
  const double rate = truth.leg_velocity_radps;
  return {d.reduced_mass_kg * truth.foot_velocity_mps,
          -d.torque_gain_per_m * torque_Nm - d.coriolis_N_s2_per_rad2 * rate * rate -
              d.reduced_mass_kg * gravity_mps2 + d.dreduced_mass_kg_per_rad * rate * truth.foot_velocity_mps};
}

std::size_t steps_until_liftoff(const NominalStride& stride) {
  std::size_t ms = 0;
  while (stride.rows[ms].phase == NominalPhase::flight) ++ms;
  while (stride.rows[ms].phase != NominalPhase::flight) ++ms;
  return 10 * ms;
}

}  // namespace

MomentumCheck momentum_balance(const WorldConfig& config) {
  WorldConfig world = config;
  world.robot.rail_coulomb_N = world.robot.joint_coulomb_Nm = world.robot.cogging_amplitude_Nm = 0.0;
  const auto stride = nominal_stride({}, world);
  const Leg leg(world.robot.leg);
  std::vector<double> difference_N;
  const std::size_t steps = steps_until_liftoff(stride);  // after liftoff the leg may hit its end stops
  for (std::size_t i = 0; i < steps; ++i) {
    const auto& now = stride.grid[i];
    const auto& next = stride.grid[i + 1];
    // The torque of a step is the one that the drives had reached at the step's end.
    const auto here = momentum_terms(leg, now, next.motor_torque_Nm, world.gravity_mps2);
    const auto there = momentum_terms(leg, next, next.motor_torque_Nm, world.gravity_mps2);
    const double step_s = 1e-9 * static_cast<double>(next.time_ns - now.time_ns);
    const double force_N =
        (there.momentum_kg_mps - here.momentum_kg_mps) / step_s - 0.5 * (here.psi_N + there.psi_N);
    const double true_N = (next.contact_impulse_Ns - now.contact_impulse_Ns) / step_s;
    difference_N.push_back(std::abs(force_N - true_N));
  }
  return {largest(difference_N), rms(difference_N)};
}

ObserverStep observer_step(double gain_per_s) {
  constexpr double kForce_N = 30.0;
  constexpr double kPsi_N = -6.5;
  constexpr int kFine = 1000;  // steps of the internal form per cycle
  MomentumObserver observer(gain_per_s);
  observer.reset(0.0);
  double momentum = 0.0, internal = 0.0, integral = 0.0, difference = 0.0;
  std::vector<double> time_s, log_remaining;
  for (int cycle = 1; cycle <= 10; ++cycle) {
    for (int i = 0; i < kFine; ++i) {
      constexpr double dt = kCycle_s / kFine;
      momentum += (kForce_N + kPsi_N) * dt;
      integral += (kPsi_N + internal) * dt;
      internal = gain_per_s * (momentum - integral);
    }
    const double force_N = observer.update(momentum, kPsi_N, kCycle_s);
    difference = std::max(difference, std::abs(force_N - internal) / kForce_N);
    time_s.push_back(cycle * kCycle_s);
    log_remaining.push_back(std::log(1.0 - force_N / kForce_N));
  }
  return {-1.0 / fit_line(time_s, log_remaining).slope, 1.0 / gain_per_s, difference};
}

namespace {

int observability_rank(const Eigen::MatrixXd& measurement) {
  Eigen::Matrix4d step = Eigen::Matrix4d::Identity();
  step(0, 1) = step(2, 3) = kCycle_s;
  Eigen::MatrixXd stacked(4 * measurement.rows(), 4);
  Eigen::Matrix4d power = Eigen::Matrix4d::Identity();
  for (int i = 0; i < 4; ++i, power = power * step)
    stacked.middleRows(i * measurement.rows(), measurement.rows()) = measurement * power;
  return static_cast<int>(Eigen::FullPivLU<Eigen::MatrixXd>(stacked).setThreshold(1e-9).rank());
}

}  // namespace

namespace {

// Mean normalised squared innovation for a synthetic motion that matches the filter's model exactly.
double mean_normalised_innovation(const KalmanConfig& c, int steps, std::uint64_t seed) {
  Random random(seed, 0);
  const auto noise = [&random](double sigma) { return sigma * random.normal(); };
  BodyFootState truth{noise(c.initial_height_noise_m), noise(c.initial_speed_noise_mps),
                      noise(c.initial_height_noise_m), noise(c.initial_speed_noise_mps)};
  const auto move = [](double& z, double& v, double accel) {
    z += kCycle_s * v + 0.5 * kCycle_s * kCycle_s * accel;
    v += kCycle_s * accel;
  };
  KalmanFilter filter(c);
  filter.reset({});
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const BodyFootAccel known{2.0 * std::sin(0.01 * i), -std::cos(0.02 * i)};
    move(truth.body_z_m, truth.body_velocity_mps, known.body_mps2 + noise(c.body_accel_noise_mps2));
    move(truth.foot_z_m, truth.foot_velocity_mps, known.foot_mps2 + noise(c.foot_accel_noise_mps2));
    const double length_m = truth.body_z_m - truth.foot_z_m;
    const double rate_mps = truth.body_velocity_mps - truth.foot_velocity_mps;
    filter.predict(known, kCycle_s);
    sum += filter.update_body_height(truth.body_z_m + noise(c.tof_noise_m), 0.0).normalised_squared;
    sum += filter.update_leg_length(length_m + noise(c.leg_length_noise_m), 0.0).normalised_squared;
    sum += filter.update_leg_rate(rate_mps + noise(c.leg_rate_noise_mps), 0.0).normalised_squared;
  }
  return sum / (3.0 * steps);
}

}  // namespace

FilterCheck filter_check(const KalmanConfig& config) {
  constexpr int kRuns = 20;
  constexpr int kSteps = 10000;
  Eigen::Matrix<double, 3, 4> h;
  h << 1, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0, -1;
  FilterCheck check{.rank_with_tof = observability_rank(h),
                    .rank_without_tof = observability_rank(h.bottomRows(2))};
  const double half_band = 1.96 * std::sqrt(2.0 / (3.0 * kSteps));  // half width of the 95 % band of the mean
                                                                    // of a chi-squared variable
  for (int run = 0; run < kRuns; ++run) {
    const double normalised = mean_normalised_innovation(config, kSteps, static_cast<std::uint64_t>(run));
    check.mean_normalised += normalised / kRuns;
    check.runs_inside_band += std::abs(normalised - 1.0) < half_band;
  }
  check.runs = kRuns;
  return check;
}

}  // namespace sandhopper::paper
