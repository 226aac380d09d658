#include "tools/diagnose/plants/rotary_axis/rotary_balance.hpp"

#include <cmath>
#include <utility>

#include "tools/diagnose/model/sign_smooth.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_figures.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr std::size_t kLeastSamples = 50;
constexpr std::size_t kMostSamples = 800;     // per trial
constexpr double kBalanceSmoothing_s = 0.02;  // to each side
// In switch speeds of the friction: below, dry friction may take any value.
constexpr double kMoves = 2.0;

// Samples interpolated to the times of another channel, and smoothed.
Smoothed smoothed_at(const std::vector<double>& time_s, const Samples& samples, double step_s,
                     std::size_t half_width) {
  const Signal signal = on_grid(samples, time_s.front(), step_s, time_s.size() + 1, false);
  Samples there{time_s, {}};
  for (const double t : time_s) there.value.push_back(signal.at(t));
  return smooth(there, half_width);
}

// Acceleration from the encoder's angle, or from its speed if that is less noisy. A parabola through n
// samples with noise s gives a second derivative with the standard deviation s sqrt(720/n^5)/dt^2, and a
// first derivative with s sqrt(12/n^3)/dt.
std::vector<double> accelerations(const Smoothed& position, double position_noise, const Samples& speed,
                                  const std::vector<double>& time_s, double step_s, std::size_t half_width) {
  if (speed.value.size() < kLeastSamples) return position.curvature;
  const double n = 2.0 * static_cast<double>(half_width) + 1.0;
  const double by_position = position_noise * std::sqrt(720.0 / std::pow(n, 5)) / (step_s * step_s);
  const double by_speed = fluctuation_rms(speed) * std::sqrt(12.0 / std::pow(n, 3)) / step_s;
  return by_position < by_speed ? position.curvature : smoothed_at(time_s, speed, step_s, half_width).rate;
}

}  // namespace

std::vector<Balance> balances_of_axis(const Trial& trial, const Belief& belief) {
  const RotaryFigures f(belief, {});
  const auto position = samples_of(trial, "position_rad");
  const auto torque = samples_of(trial, "torque_Nm");
  const std::size_t count = position.value.size();
  if (count < kLeastSamples || torque.value.size() < kLeastSamples) return {};
  const double step_s = median_step_s(position.time_s);
  const auto half = static_cast<std::size_t>(std::clamp(kBalanceSmoothing_s / step_s, 2.0, 12.0));
  const Smoothed at = smooth(position, half);
  const Smoothed acting = smoothed_at(position.time_s, torque, step_s, half);
  const auto accel = accelerations(at, fluctuation_rms(position), samples_of(trial, "velocity_radps"),
                                   position.time_s, step_s, half);

  const auto turned = last_turns(at.value, kTurn_rad);
  Balance balance{"axis", {}, {}, {}};
  const auto know = [&](std::initializer_list<double> shapes) {
    balance.known.resize(shapes.size());
    auto column = balance.known.begin();
    for (const double shape : shapes) (column++)->push_back(shape);
  };
  const std::size_t stride = 1 + count / kMostSamples;
  for (std::size_t i = half; i + half < count; i += stride) {
    const double angle = at.value[i], speed = at.rate[i], tau = acting.value[i];
    if (std::abs(speed) < kMoves * f.switch_speed_radps) continue;
    const double needed = f.inertia_kg_m2 * accel[i] + f.gravity_torque_Nm * std::sin(angle - f.bottom_rad) +
                          f.viscous_Nm_s * speed + f.coulomb_Nm * sign_smooth(speed, f.switch_speed_radps);
    balance.rest.push_back(needed - tau);
    balance.states.push_back(AxisState{.time_s = position.time_s[i],
                                       .angle_rad = angle,
                                       .velocity_radps = speed,
                                       .torque_Nm = tau,
                                       .turned_rad = turned[i]});
    // Regressors: friction (dry, with the load, near standstill, with the speed and its square), gravity and
    // its bottom angle, inertia, delay. An error of the drive's constant scales all of these. The torque
    // itself is no regressor: together with these it would leave nothing.
    const double sign = std::copysign(1.0, speed);
    const auto near_rest = [&](double within_radps) {
      return sign * std::exp(-std::pow(speed / within_radps, 2));
    };
    know({sign, sign * std::abs(tau), near_rest(0.1), near_rest(0.4), speed, speed * std::abs(speed),
          std::sin(angle), std::cos(angle), accel[i], acting.rate[i]});
  }
  return {std::move(balance)};
}

}  // namespace sandhopper::diagnose
