#include "tools/diagnose/effects/axis/axis_friction.hpp"

namespace sandhopper::diagnose {
namespace {

// Largest Stribeck speed of bearings and gears. Friction that decays over several rad/s has another cause.
constexpr double kFastest_radps = 1.5;
// Below this tail parameter the curve is taken as exp(-(w/w_s)^2).
constexpr double kNoTail = 1e-3;

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!c.facts.moves) return {};
  const double torque = 0.1 * c.facts.torque_Nm;
  // Below the switch speed all dry friction goes to zero, so a smaller Stribeck speed is not observable.
  const double slowest = 2.0 * switch_speed_radps(c), fastest = std::max(kFastest_radps, 4.0 * slowest);
  const double speed = std::clamp(0.05 * c.facts.speed_radps, 1.5 * slowest, 0.5 * fastest);
  return {{.name = "stribeck_torque_Nm", .typical = torque, .low = 0.0, .high = 50.0 * torque},
          {.name = "stribeck_speed_radps",
           .typical = speed,
           .low = slowest,
           .high = fastest,
           .other_law_above = true,
           .shapes = {slowest, 0.8 * fastest}},
          {.name = "tail", .high = 2.0, .shapes = {0.0}}};
}

const EffectRegistration kEffect(
    {.id = "axis.stribeck",
     .port = Port::axis,
     .statement = "Near standstill dry friction is larger than in motion (Stribeck).",
     .equation = "tau += -dF (1 + q (w/w_s)^2)^(-1/q) sign(w); tail q: 0 exp(-(w/w_s)^2), 1 Hess and Soom",
     .bench_tests =
         {{.sentence = "Pull the axis by a torque gauge from rest to a slow turn with the drive off: a peak "
                       "just before it turns, and less torque as it speeds up, is Stribeck friction."}},
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
       const double torque = v[0], speed = v[1], tail = v[2];
       const double switch_speed = switch_speed_radps(c);
       edits.law(LawPort::axis, [=](const AxisState& s) {
         const double square = std::pow(s.velocity_radps / speed, 2);
         const double left = tail > kNoTail ? std::pow(1.0 + tail * square, -1.0 / tail) : std::exp(-square);
         return -torque * left * sign_smooth(s.velocity_radps, switch_speed);
       });
     }});

}  // namespace
}  // namespace sandhopper::diagnose
