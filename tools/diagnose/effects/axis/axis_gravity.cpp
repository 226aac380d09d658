#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("axis.gravity_torque_Nm", 0.0);
  const double typical = std::max(0.1 * std::abs(believed), 0.1 * c.facts.torque_Nm);
  EffectParameter torque{.name = "gravity_torque_Nm",
                         .typical = typical,
                         .low = -100.0 * typical,
                         .high = 100.0 * typical,
                         .either_sign = true,
                         .base = believed};
  if (believed != 0.0) {
    torque.other_name = "gravity_change_fraction";
    torque.other_scale = 1.0 / believed;
  }
  return {torque};
}

const EffectRegistration kEffect(
    {.id = "axis.gravity",
     .port = Port::inertia,
     .statement = "The torque of gravity on the axis is not the believed one.",
     .equation = "tau += -dG sin(theta)",
     .bench_tests =
         {{.sentence =
               "Lift and lower the level arm slowly by a force gauge with the drive off: the mean of the two "
               "forces times the lever is the torque of gravity, free of friction and of the drive."}},
     .plants = {PlantKind::rotary_axis},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("axis.gravity_torque_Nm", v[0]); },
     .belief_key = "axis.gravity_torque_Nm"});

}  // namespace
}  // namespace sandhopper::diagnose
