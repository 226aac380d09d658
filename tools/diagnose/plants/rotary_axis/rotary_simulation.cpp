#include "tools/diagnose/plants/rotary_axis/rotary_simulation.hpp"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
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

// Angular acceleration during a stretch.
class Equation {
 public:
  Equation(const RotaryFigures& figures, const std::vector<const Law*>& laws, const AxisInputs& inputs,
           const AxisStretch& stretch)
      : f_(figures), laws_(laws), inputs_(inputs), s_(stretch) {}

  template <class Sine>
  double operator()(const Sine& sine, double t, double torque_Nm, double angle, double speed) const {
    double sum = torque_Nm - f_.gravity_torque_Nm * sine(angle - f_.bottom_rad) - f_.viscous_Nm_s * speed;
    if (f_.coulomb_Nm != 0.0) sum -= f_.coulomb_Nm * sign_smooth(speed, f_.switch_speed_radps);
    if (!laws_.empty())
      sum += sum_of(laws_, AxisState{.time_s = t,
                                     .angle_rad = angle,
                                     .velocity_radps = speed,
                                     .torque_Nm = torque_Nm,
                                     .turned_rad = turned_at(inputs_.turned_at, t)});
    return sum / f_.inertia_kg_m2;
  }

  double torque_Nm(double t) const {  // mean of the step that begins then
    const double at = (2.0 * t - s_.from_s - s_.to_s) / (s_.to_s - s_.from_s);
    return s_.torque_Nm + at * s_.torque_rise_Nm + inputs_.torque.values[step_of(t, inputs_.torque)];
  }

 private:
  const RotaryFigures& f_;
  const std::vector<const Law*>& laws_;
  const AxisInputs& inputs_;
  const AxisStretch& s_;
};

struct Motion {
  double angle_rad, speed_radps;
};

// Steps of the torque's grid, each divided where friction near rest is stiff: its own rate limits the step.
class DrivenSteps {
 public:
  DrivenSteps(const RotaryFigures& f, const Equation& equation, const AxisInputs& inputs, bool has_laws)
      : f_(f),
        equation_(equation),
        inputs_(inputs),
        least_(has_laws ? 2.0 : 1.0),
        slow_(
            std::ceil(inputs.torque.step_s * f.coulomb_Nm / (f.inertia_kg_m2 * f.switch_speed_radps) / 1.5)) {
  }

  void advance(double t0, Motion& m) const {
    const double tau = equation_.torque_Nm(t0), rise = rise_at(t0, inputs_.torque);
    const bool near_rest = std::abs(m.speed_radps) < 8.0 * f_.switch_speed_radps;
    const int parts = static_cast<int>(std::clamp(near_rest ? slow_ : 1.0, least_, kMostParts));
    const double dt = inputs_.torque.step_s / parts;
    double &th = m.angle_rad, &w = m.speed_radps;
    for (int k = 0; k < parts; ++k) {
      const double t = t0 + dt * k, half = 0.5 / parts;
      const double middle = tau + rise * ((k + 0.5) / parts - 0.5);
      const NearbySine sine(th - f_.bottom_rad);
      const double a1 = equation_(sine, t, middle - half * rise, th, w);
      const double a2 = equation_(sine, t, middle, th + 0.5 * dt * w, w + 0.5 * dt * a1);
      const double a3 = equation_(sine, t, middle, th + 0.5 * dt * (w + 0.5 * dt * a1), w + 0.5 * dt * a2);
      const double a4 = equation_(sine, t, middle + half * rise, th + dt * (w + 0.5 * dt * a2), w + dt * a3);
      th += dt * (w + dt * (a1 + a2 + a3) / 6.0);
      w += dt * (a1 + 2.0 * (a2 + a3) + a4) / 6.0;
      w = std::clamp(w, -kFastest_radps, kFastest_radps);
    }
  }

  // Most parts of a step. A speed that exceeds the limit belongs to a diverging simulation.
  static constexpr double kMostParts = 40.0, kFastest_radps = 1e4;

 private:
  const RotaryFigures& f_;
  const Equation& equation_;
  const AxisInputs& inputs_;
  double least_, slow_;
};

// An axis that nothing drives moves smoothly over many rows: Dormand and Prince's method of fifth order with
// controlled steps (Boost.Odeint), read between them by Hermite's polynomials. Steps are never shorter than
// the shortest of a driven axis: where the error would ask for it, that step is taken by the classical
// method.
class FreeSteps {
 public:
  FreeSteps(const Equation& equation, const AxisInputs& inputs, double start_s, const Motion& start)
      : equation_(equation),
        shortest_s_(inputs.torque.step_s / DrivenSteps::kMostParts),
        longest_s_(kLongest * inputs.torque.step_s),
        step_s_(inputs.torque.step_s) {
    from_ = to_ = {start_s, {start.angle_rad, start.speed_radps}, {}};
    (*this)(to_.x, to_.rate, start_s);
    from_ = to_;
  }

  // Times must not decrease.
  Motion at(double t) {
    while (to_.time_s < t) step();
    const double h = to_.time_s - from_.time_s;
    return h > 0.0 ? between((t - from_.time_s) / h, h) : Motion{to_.x[0], to_.x[1]};
  }

  using State = std::array<double, 2>;  // angle [rad], speed [rad/s]
  void operator()(const State& x, State& rate, double t) const {
    const auto sine = [](double angle) { return std::sin(angle); };
    rate = {x[1], equation_(sine, t, equation_.torque_Nm(t), x[0], x[1])};
  }

 private:
  struct Node {
    double time_s;
    State x, rate;
  };
  static constexpr double kTolerance = 1e-8;  // rad and rad/s a step: far below any encoder
  static constexpr double kLongest = 16.0;    // steps of the grid

  void step() {
    namespace odeint = boost::numeric::odeint;
    from_ = to_;
    while (step_s_ >= shortest_s_) {
      step_s_ = std::min(step_s_, longest_s_);
      if (controlled_.try_step(std::cref(*this), from_.x, from_.rate, to_.time_s, to_.x, to_.rate, step_s_) ==
          odeint::success)
        return hold_in_bounds();
    }
    odeint::runge_kutta4<State>().do_step(std::cref(*this), from_.x, from_.rate, from_.time_s, to_.x,
                                          shortest_s_);
    to_.time_s = from_.time_s + shortest_s_;
    step_s_ = 2.0 * shortest_s_;
    (*this)(to_.x, to_.rate, to_.time_s);
    hold_in_bounds();
  }

  void hold_in_bounds() {
    to_.x[1] = std::clamp(to_.x[1], -DrivenSteps::kFastest_radps, DrivenSteps::kFastest_radps);
  }

  // Angle: the polynomial of fifth degree through angle, speed and acceleration of both ends; speed: its
  // derivative.
  Motion between(double u, double h) const {
    const double v0 = h * from_.x[1], v1 = h * to_.x[1];
    const double a0 = 0.5 * h * h * from_.rate[1], a1 = 0.5 * h * h * to_.rate[1];
    const double d = to_.x[0] - from_.x[0];
    const double r0 = d - v0 - a0, r1 = v1 - v0 - 2.0 * a0, r2 = a1 - a0;
    const double c3 = 10.0 * r0 - 4.0 * r1 + r2, c4 = -15.0 * r0 + 7.0 * r1 - 2.0 * r2,
                 c5 = 6.0 * r0 - 3.0 * r1 + r2;
    return {from_.x[0] + u * (v0 + u * (a0 + u * (c3 + u * (c4 + u * c5)))),
            (v0 + u * (2.0 * a0 + u * (3.0 * c3 + u * (4.0 * c4 + u * 5.0 * c5)))) / h};
  }

  const Equation& equation_;
  double shortest_s_, longest_s_, step_s_;
  Node from_, to_;
  using Method = boost::numeric::odeint::runge_kutta_dopri5<State>;
  boost::numeric::odeint::controlled_runge_kutta<Method> controlled_ =
      boost::numeric::odeint::make_controlled(kTolerance, kTolerance, Method());
};

}  // namespace

void simulate_axis(const RotaryFigures& f, const std::vector<const Law*>& laws, const AxisInputs& inputs,
                   const AxisStretch& s, double lead_in_s, Signal& position, Signal& velocity) {
  const double step_s = inputs.torque.step_s;
  const auto lead_in = static_cast<std::size_t>(std::ceil(lead_in_s / step_s));
  const auto count = lead_in + static_cast<std::size_t>(std::ceil((s.to_s - s.from_s) / step_s)) + 2;
  position.start_s = velocity.start_s = s.from_s - step_s * static_cast<double>(lead_in);
  position.values.resize(count);
  velocity.values.resize(count);
  const Equation equation(f, laws, inputs, s);
  Motion now{s.position, s.velocity};
  // A late reading shows the motion before the stretch: extrapolate it with a constant acceleration.
  const double first = equation(NearbySine(s.position - f.bottom_rad), s.from_s, equation.torque_Nm(s.from_s),
                                s.position, s.velocity);
  for (std::size_t i = 0; i < lead_in; ++i) {
    const double t = -step_s * static_cast<double>(lead_in - i);
    position.values[i] = s.position + t * (s.velocity + 0.5 * t * first);
    velocity.values[i] = s.velocity + t * first;
  }
  const auto write = [&](std::size_t i) {
    position.values[i] = now.angle_rad;
    velocity.values[i] = now.speed_radps;
  };
  const auto time_of = [&](std::size_t i) { return s.from_s + step_s * static_cast<double>(i - lead_in); };
  if (inputs.is_driven) {
    const DrivenSteps steps(f, equation, inputs, !laws.empty());
    for (std::size_t i = lead_in; i < count; ++i) {
      write(i);
      steps.advance(time_of(i), now);
    }
    return;
  }
  FreeSteps steps(equation, inputs, s.from_s, now);
  for (std::size_t i = lead_in; i < count; ++i) {
    now = steps.at(time_of(i));
    write(i);
  }
}

}  // namespace sandhopper::diagnose
