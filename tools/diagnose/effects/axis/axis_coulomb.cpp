#include "tools/diagnose/effects/axis/axis_friction.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  if (!c.facts.moves) return {};
  const double believed = c.belief.value("axis.coulomb_friction_Nm", 0.0);
  const double typical = 0.1 * c.facts.torque_Nm;
  std::vector<EffectParameter> all{{.name = "coulomb_friction_Nm",
                                    .typical = typical,
                                    .low = -believed,
                                    .high = 100.0 * typical,
                                    .either_sign = false,
                                    .base = believed}};
  // The believed switch speed belongs to the believed friction; new friction may have another one.
  if (believed == 0.0) all.push_back(own_switch_speed(c));
  return all;
}

void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  edits.add("axis.coulomb_friction_Nm", v[0]);
  if (v.size() > 1) edits.add(kAxisSwitchSpeed, v[1] - switch_speed_radps(c));
}

bool as_keys(const Context& c, std::span<const double> v, std::map<std::string, double>& numbers) {
  numbers["axis.coulomb_friction_Nm"] = c.belief.value("axis.coulomb_friction_Nm", 0.0) + v[0];
  if (v.size() > 1) numbers[kAxisSwitchSpeed] = v[1];
  return true;
}

const EffectRegistration kEffect(
    {.id = "axis.coulomb",
     .port = Port::axis,
     .statement = "Dry friction of constant size opposes the axis.",
     .equation = "tau += -c sign(w)",
     .bench_tests =
         {{.sentence =
               "Turn the axis by a torque gauge with the drive off, slowly and at twice the speed, both "
               "ways: dry friction takes the same torque at both speeds and turns with the direction."}},
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = apply,
     .belief_key = "axis.coulomb_friction_Nm",
     .as_keys = as_keys});

}  // namespace
}  // namespace sandhopper::diagnose
