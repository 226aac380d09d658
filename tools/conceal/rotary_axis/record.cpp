#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/conceal/core/dormand_prince.hpp"
#include "tools/conceal/rotary_axis/world.hpp"

namespace sandhopper::conceal::rotary_axis {
namespace {

constexpr double kTick_s = 1e-3;  // cycle of the drive's own position loop
constexpr int kSettling = 2000;   // Cycles before the recording starts.
constexpr double kPi = std::numbers::pi;
using State = std::array<double, 3>;  // position, velocity, stretch of the hysteretic spring

double triangle(double phase) {  // -1 … 1, rising through zero
  const double p = phase - std::floor(phase);
  return p < 0.25 ? 4.0 * p : p < 0.75 ? 2.0 - 4.0 * p : 4.0 * p - 4.0;
}

bool free_swing(const Setup& setup) {
  return setup.kind() != "hold" && setup.text("profile", "sine") == "release";
}

// Target angle before smoothing.
double target_rad(const Setup& setup, double t_s) {
  const auto profile = setup.text("profile", "sine");
  const double amplitude = setup.number("amplitude_rad", 1.0);
  if (setup.kind() == "hold") return setup.number("position_rad", 0.5);
  if (profile == "steps") {
    const auto step = static_cast<int>(t_s / setup.number("hold_s", 1.0));
    constexpr double kLevels[] = {0.0, 0.5, 1.0, 0.3, -0.4, -1.0, -0.6, 0.2};
    return amplitude * kLevels[step % 8];
  }
  if (profile == "ramp")
    return amplitude * triangle(t_s * setup.number("speed_radps", 1.0) / (4.0 * amplitude));
  const double f0 = setup.number("frequency_Hz", 0.5), f1 = setup.number("end_frequency_Hz", f0);
  const double rate = (f1 - f0) / setup.number("duration_s", 6.0);
  return amplitude * std::sin(2.0 * kPi * (f0 * t_s + 0.5 * rate * t_s * t_s));
}

// Target smoothed by a critically damped second order with 4 Hz. Steps would make the torque jump, and slow
// rows would not record that.
struct Reference {
  double position_rad = 0.0, velocity_radps = 0.0;

  void follow(double target_rad) {
    constexpr double kPole = 2.0 * kPi * 4.0;
    velocity_radps += kTick_s * (kPole * kPole * (target_rad - position_rad) - 2.0 * kPole * velocity_radps);
    position_rad += kTick_s * velocity_radps;
  }
};

double hidden_torque_Nm(const World& w, const State& x, double torque_Nm, double& spring_rate) {
  const auto& h = w.hidden;
  const double th = x[0], v = x[1];
  const double side = 2.0 / kPi * std::atan(v / h.coulomb_width_radps);
  const double load_Nm = std::abs(torque_Nm) + std::abs(w.gravity_torque_Nm * std::sin(th));
  const double slow = v / h.stribeck_speed_radps;
  double sum = -side * (h.coulomb_Nm + h.stribeck_Nm / (1.0 + slow * slow) + h.load_dependent * load_Nm);
  const double swift = v / h.brake_speed_radps;
  sum -= h.viscous_Nm_s * v + h.brake_Nm * 2.0 * swift / (1.0 + swift * swift);
  sum += h.cogging_Nm * std::sin(h.cogging_per_rev * th + h.cogging_phase_rad);
  const double off = (th - h.magnet_at_rad) / h.magnet_width_rad;
  sum -= h.magnet_Nm * off * std::exp(0.5 * (1.0 - off * off));
  if (th > h.rub_from_rad && th < h.rub_to_rad) sum -= h.rub_Nm * side;
  // The stretch follows the motion until it yields.
  const double load = x[2] / h.spring_yield_rad;
  spring_rate = v - std::abs(v) * load * std::abs(load);
  return sum - h.spring_Nm_per_rad * x[2];
}

State slope(const World& w, const State& x, double torque_Nm) {
  const auto& h = w.hidden;
  double spring_rate = 0.0;
  const double hidden_Nm = hidden_torque_Nm(w, x, torque_Nm, spring_rate);
  const double gravity_Nm = w.gravity_torque_Nm * (1.0 + h.gravity_share) * std::sin(x[0] - h.offset_rad);
  const double friction_Nm =
      w.viscous_Nm_s * x[1] + w.coulomb_Nm * std::tanh(x[1] / w.friction_switch_speed_radps);
  const double sum_Nm = torque_Nm - gravity_Nm - friction_Nm + hidden_Nm;
  return {x[1], sum_Nm / (w.inertia_kg_m2 * (1.0 + h.inertia_share)), spring_rate};
}

// Torque delivered if the current corresponds to `reported_Nm`.
double delivered_Nm(const World& w, double reported_Nm) {
  const auto& h = w.hidden;
  const double load = reported_Nm / h.saturation_torque_Nm;
  return reported_Nm * (1.0 + h.torque_scale) * (1.0 - h.saturation * std::min(load * load, 1.0));
}

struct Motion {
  Trace position_rad, velocity_radps, torque_Nm, delivered_Nm;
};

double command_Nm(const World& w, const Reference& goal, const State& x) {
  constexpr double kEncoder_rad = 2.0 * kPi / 16384.0 / 6.0;  // on the motor's side of the gear
  const double seen = kEncoder_rad * std::round(x[0] / kEncoder_rad);
  const double stiffness = 400.0 * w.inertia_kg_m2, damping = 30.0 * w.inertia_kg_m2;
  const double torque_Nm = stiffness * (goal.position_rad - seen) + damping * (goal.velocity_radps - x[1]) +
                           w.gravity_torque_Nm * std::sin(seen);
  return std::clamp(torque_Nm, -0.9 * w.torque_range_Nm, 0.9 * w.torque_range_Nm);
}

Motion simulate(const World& w, const Setup& setup, const TrialRandom& trial) {
  Motion m;
  for (auto* trace : {&m.position_rad, &m.velocity_radps, &m.torque_Nm, &m.delivered_Nm})
    trace->step_s = kTick_s;
  const double spread = trial.stream("release").normal(0.0, w.initial_position_spread_rad);
  const double stray_Nm = trial.stream("torque offset").normal(0.0, w.torque_offset_spread_Nm);
  State x{setup.number(setup.kind() == "hold" ? "position_rad" : "release_position_rad", 0.0) + spread, 0.0,
          0.0};
  DormandPrince<3> integrator({1e-7, 1e-8, 1e-6});
  const auto never = [](double, const State&) { return 1.0; };
  // An arm that is held is at rest when the recording starts.
  const int before = setup.kind() == "hold" ? kSettling : 0;
  const auto ticks =
      before + static_cast<int>(std::lround(setup.number("duration_s", w.duration_s) / kTick_s));
  const bool free = free_swing(setup);
  Reference goal{setup.kind() == "hold" ? x[0] : 0.0, 0.0};
  Trace reported{kTick_s, {0.0}};
  double t_s = 0.0;
  for (int i = 0; i <= ticks; ++i) {
    goal.follow(free ? 0.0 : target_rad(setup, t_s));
    const double now_Nm = reported.values.back();
    const double next_Nm = free ? 0.0 : now_Nm + 0.6 * (command_Nm(w, goal, x) - now_Nm);  // current loop
    reported.values.push_back(next_Nm);
    // Between cycles the torque is interpolated linearly, as a user of the recording would assume.
    const auto acting_Nm = [&](double t) {
      return delivered_Nm(w, reported.at(t - w.hidden.delay_s)) + stray_Nm;
    };
    m.position_rad.values.push_back(x[0]);
    m.velocity_radps.values.push_back(x[1]);
    m.torque_Nm.values.push_back(now_Nm);
    m.delivered_Nm.values.push_back(acting_Nm(t_s));
    integrator.advance(
        t_s, x, (i + 1) * kTick_s, [&](double t, const State& y) { return slope(w, y, acting_Nm(t)); },
        never);
  }
  for (auto* trace : {&m.position_rad, &m.velocity_radps, &m.torque_Nm, &m.delivered_Nm})
    trace->values.erase(trace->values.begin(), trace->values.begin() + before);
  return m;
}

double step_of(double range, int bits) { return 2.0 * range / ((1 << bits) - 1); }

}  // namespace

Table record(const World& w, const Setup& setup, const TrialRandom& trial) {
  auto motion = simulate(w, setup, trial);
  for (double& p : motion.position_rad.values)
    p += w.eccentricity_rad * std::sin(p + w.eccentricity_phase_rad);
  const auto rows =
      static_cast<std::size_t>(std::lround(setup.number("duration_s", w.duration_s) * w.row_rate_Hz));
  auto jitter = trial.stream("jitter");
  std::vector<double> rows_s(rows);
  for (std::size_t i = 0; i < rows; ++i)
    rows_s[i] =
        i == 0 ? 0.0 : static_cast<double>(i) / w.row_rate_Hz + 1e-6 * std::round(jitter.uniform(0.0, 20.0));
  Table table;
  table.add("t_s", 6).values = rows_s;
  const auto add = [&](const char* name, const Trace& truth, ChannelChain chain) {
    record_channel(table, name, truth, rows_s, chain, w.faults_of(name), trial);
  };
  add("position_rad", motion.position_rad,
      {.noise = w.position_noise_rad,
       .quantum = step_of(w.position_range_rad, w.position_bits),
       .decimals = 8});
  add("velocity_radps", motion.velocity_radps,
      {.bandwidth_Hz = w.velocity_bandwidth_Hz,
       .noise = w.velocity_noise_radps,
       .quantum = step_of(w.velocity_range_radps, w.velocity_bits),
       .decimals = 8});
  add("torque_Nm", motion.torque_Nm,
      {.noise = w.torque_noise_Nm, .quantum = step_of(w.torque_range_Nm, w.torque_bits), .decimals = 8});
  if (w.bench_load_cell)
    add("load_cell_torque_Nm", motion.delivered_Nm,
        {.bandwidth_Hz = 300.0, .noise = w.torque_noise_Nm, .decimals = 5});
  return table;
}

}  // namespace sandhopper::conceal::rotary_axis
