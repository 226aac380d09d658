#include "tools/diagnose/plants/rotary_axis/rotary_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/model/sign_smooth.hpp"
#include "tools/diagnose/plants/rotary_axis/nearby_sine.hpp"

namespace sandhopper::diagnose {
namespace {

double turned_at(const Signal& turned, double t) {
  return turned
      .values[std::min(turned.values.size() - 1, static_cast<std::size_t>(std::max(0.0, t / turned.step_s)))];
}

std::size_t step_of(double t, const Signal& torque) {
  return std::min(torque.values.size() - 1,
                  static_cast<std::size_t>(std::max(0.0, std::round(t / torque.step_s))));
}

// Rise of the torque over the step that begins at `t`.
double rise_at(double t, const Signal& torque) {
  const std::size_t i = step_of(t, torque);
  return i == 0 || i + 1 == torque.values.size() ? 0.0 : 0.5 * (torque.values[i + 1] - torque.values[i - 1]);
}

}  // namespace

void simulate_axis(const RotaryFigures& f, const std::vector<const Law*>& laws, const AxisInputs& inputs,
                   const AxisStretch& s, double lead_in_s, Signal& position, Signal& velocity) {
  const double step_s = inputs.torque.step_s;
  const auto lead_in = static_cast<std::size_t>(std::ceil(lead_in_s / step_s));
  const auto count = lead_in + static_cast<std::size_t>(std::ceil((s.to_s - s.from_s) / step_s)) + 2;
  position.start_s = velocity.start_s = s.from_s - step_s * static_cast<double>(lead_in);
  position.values.resize(count);
  velocity.values.resize(count);
  double th = s.position, w = s.velocity;
  // Friction near rest is stiff: its own rate limits the step.
  const double stiffness_per_s = f.coulomb_Nm / (f.inertia_kg_m2 * f.switch_speed_radps);
  const double slow_steps = std::ceil(step_s * stiffness_per_s / 1.5);
  const auto accel = [&](const NearbySine& sine, double t, double torque_Nm, double angle, double speed) {
    double sum = torque_Nm - f.gravity_torque_Nm * sine(angle - f.bottom_rad) - f.viscous_Nm_s * speed;
    if (f.coulomb_Nm != 0.0) sum -= f.coulomb_Nm * sign_smooth(speed, f.switch_speed_radps);
    if (!laws.empty())
      sum += sum_of(laws, AxisState{.time_s = t,
                                    .angle_rad = angle,
                                    .velocity_radps = speed,
                                    .torque_Nm = torque_Nm,
                                    .turned_rad = turned_at(inputs.turned_at, t)});
    return sum / f.inertia_kg_m2;
  };
  const auto torque_at = [&](double t) {  // mean of the step that begins then
    const double at = (2.0 * t - s.from_s - s.to_s) / (s.to_s - s.from_s);
    return s.torque_Nm + at * s.torque_rise_Nm + inputs.torque.values[step_of(t, inputs.torque)];
  };
  // A late reading shows the motion before the stretch: extrapolate it with a constant acceleration.
  const double first = accel(NearbySine(th - f.bottom_rad), s.from_s, torque_at(s.from_s), th, w);
  for (std::size_t i = 0; i < lead_in; ++i) {
    const double t = -step_s * static_cast<double>(lead_in - i);
    position.values[i] = th + t * (w + 0.5 * t * first);
    velocity.values[i] = w + t * first;
  }
  for (std::size_t i = lead_in; i < count; ++i) {
    position.values[i] = th;
    velocity.values[i] = w;
    const double t0 = s.from_s + step_s * static_cast<double>(i - lead_in);
    const double tau = torque_at(t0), rise = rise_at(t0, inputs.torque);
    const bool near_rest = std::abs(w) < 8.0 * f.switch_speed_radps;
    const int parts =
        static_cast<int>(std::clamp(near_rest ? slow_steps : 1.0, !laws.empty() ? 2.0 : 1.0, 40.0));
    const double dt = step_s / parts;
    for (int k = 0; k < parts; ++k) {
      const double t = t0 + dt * k, half = 0.5 / parts;
      const double middle = tau + rise * ((k + 0.5) / parts - 0.5);
      const NearbySine sine(th - f.bottom_rad);
      const double a1 = accel(sine, t, middle - half * rise, th, w);
      const double a2 = accel(sine, t, middle, th + 0.5 * dt * w, w + 0.5 * dt * a1);
      const double a3 = accel(sine, t, middle, th + 0.5 * dt * (w + 0.5 * dt * a1), w + 0.5 * dt * a2);
      const double a4 = accel(sine, t, middle + half * rise, th + dt * (w + 0.5 * dt * a2), w + dt * a3);
      th += dt * (w + dt * (a1 + a2 + a3) / 6.0);
      w += dt * (a1 + 2.0 * (a2 + a3) + a4) / 6.0;
      w = std::clamp(w, -1e4, 1e4);
    }
  }
}

}  // namespace sandhopper::diagnose
