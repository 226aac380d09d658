#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double typical = 0.1 * c.facts.torque_Nm;
  // The fit starts from the periods per turn found in the recordings.
  std::vector<double> orders;
  constexpr std::size_t kMost = 3;
  for (std::size_t i = 0; i < c.facts.ripple_orders.size() && i < kMost; ++i)
    if (const double order = c.facts.ripple_orders[i]; order >= c.facts.fewest_ripples)
      orders.push_back(order);
  if (orders.empty()) return {};
  const double likeliest = orders.front();
  const auto of_sine = [&](const char* name, bool amplitude) {
    return EffectParameter{.name = name,
                           .typical = typical,
                           .low = -50.0 * typical,
                           .high = 50.0 * typical,
                           .amplitude = amplitude};
  };
  return {of_sine("cogging_sin_Nm", false),
          of_sine("cogging_cos_Nm", true),
          {.name = "cogging_periods_per_rev",
           .typical = likeliest,
           .low = c.facts.fewest_ripples,
           .high = 500.0,
           .shapes = orders},
          // The second harmonic.
          of_sine("cogging_second_sin_Nm", true),
          of_sine("cogging_second_cos_Nm", true)};
}

const EffectRegistration kEffect(
    {.id = "joint.cogging",
     .port = Port::joint,
     .statement = "Torque ripples with the angle of the motor (cogging).",
     .equation = "tau += A sin(h theta) + B cos(h theta) + A_2 sin(2 h theta) + B_2 cos(2 h theta)",
     .bench_tests = {{.sentence = "Turn the motor slowly both ways by a torque gauge without current: "
                                  "cogging repeats at the same angles with the same sign, friction turns "
                                  "with the direction, an encoder gives no torque."}},
     .plants = {PlantKind::rotary_axis, PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
       const double a = v[0], b = v[1], h = v[2], a2 = v[3], b2 = v[4];
       edits.law(port_on(c.plant, Port::joint) == Port::axis ? LawPort::axis : LawPort::joint,
                 [=](const AxisState& s) {
                   const double sin = std::sin(h * s.angle_rad), cos = std::cos(h * s.angle_rad);
                   return a * sin + b * cos + 2.0 * a2 * sin * cos + b2 * (1.0 - 2.0 * sin * sin);
                 });
     }});

}  // namespace
}  // namespace sandhopper::diagnose
