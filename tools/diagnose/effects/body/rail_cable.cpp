#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

// The rest height starts near the height of the resting body. A spring with a distant zero would act like a
// constant force.
const EffectRegistration kEffect(
    {.id = "rail.cable",
     .port = Port::rail,
     .statement = "The cable pulls at the body like a spring, perhaps damped.",
     .equation = "F += -k (z - z_0 + T z')",
     .bench_tests =
         {{.sentence =
               "Pull the unpowered body along the rail by a force gauge, with the cable on and off: a force "
               "that changes with height and goes with the cable is the cable, not mass or friction."}},
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "cable_stiffness_N_per_m", .typical = 5.0, .low = 0.0, .high = 200.0},
               {.name = "cable_rest_height_m", .typical = 0.4, .low = -1.0, .high = 2.0},
               {.name = "cable_damping_s", .typical = 0.1, .low = 0.0, .high = 2.0, .shapes = {0.0}}};
         },
     .apply =
         [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
           const double stiffness = v[0], rest = v[1], damping = v[2];
           edits.law(LawPort::rail, [=](const RailState& s) {
             return -stiffness * (s.height_m - rest + damping * s.velocity_mps);
           });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
