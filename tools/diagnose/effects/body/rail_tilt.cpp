#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// On a tilted rail the component g cos(alpha) acts along it, and g sin(alpha) presses on it.
void apply(const Context& c, const std::string&, std::span<const double> v, Edits& edits) {
  const double tilt = v[0], pressed_N = v[1] * c.facts.weight_N * std::sin(tilt);
  edits.scale("gravity_mps2", std::cos(tilt));
  edits.law(LawPort::rail,
            [=](const RailState& s) { return -pressed_N * sign_smooth(s.velocity_mps, kSwitchSpeed_mps); });
}

const EffectRegistration kEffect(
    {.id = "rail.tilt",
     .port = Port::rail,
     .statement = "The rail is not vertical.",
     .equation = "g -> g cos(alpha), F += -mu m g sin(alpha) sign(v)",
     .bench_tests = {{.sentence = "Hold a plumb line to the rail: a tilt shows there at once, while a wrong "
                                  "mass, friction or a faulty accelerometer leaves the rail upright."}},
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "tilt_rad", .typical = 0.06, .low = 0.0, .high = 0.5},
               // Between body and rail: from rolling bearings (0.01) to dry bushings (0.5).
               {.name = "friction_coefficient", .typical = 0.1, .low = 0.01, .high = 0.5, .shapes = {0.2}}};
         },
     .apply = apply});

}  // namespace
}  // namespace sandhopper::diagnose
