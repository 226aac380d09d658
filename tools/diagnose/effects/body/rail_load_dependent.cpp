#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "rail.load_dependent",
     .port = Port::rail,
     .statement = "The rail's friction grows with the force that the leg carries.",
     .equation = "F += -mu |F_leg| sign(v)",
     .bench_tests = {{.sentence =
                          "Pull the unpowered body along the rail by a force gauge, with and without a "
                          "weight that pulls it sideways: only friction that depends on the load grows."}},
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "friction_coefficient", .typical = 0.02, .low = 0.0, .high = 0.5}};
         },
     .apply =
         [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
           const double mu = v[0];
           edits.law(LawPort::rail, [=](const RailState& s) {
             return -mu * std::abs(s.leg_force_N) * sign_smooth(s.velocity_mps, kSwitchSpeed_mps);
           });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
