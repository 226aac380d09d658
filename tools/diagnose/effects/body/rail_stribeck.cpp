#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "rail.stribeck",
     .port = Port::rail,
     .statement = "Near standstill the rail's friction is larger than in motion (Stribeck).",
     .equation = "F += -dF exp(-(v/v_s)^2) sign(v)",
     .bench_tests = {{.sentence =
                          "Pull the resting, unpowered body along the rail by a force gauge until it slides: "
                          "a peak before it slides, and less force as it speeds up, is Stribeck friction."}},
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "stribeck_force_N", .typical = 2.0, .low = 0.0, .high = 50.0},
               {.name = "stribeck_speed_mps", .typical = 0.03, .low = 0.003, .high = 0.5, .shapes = {0.1}}};
         },
     .apply =
         [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
           const double force = v[0], speed = v[1];
           edits.law(LawPort::rail, [=](const RailState& s) {
             const double u = s.velocity_mps / speed;
             return -force * std::exp(-u * u) * sign_smooth(s.velocity_mps, kSwitchSpeed_mps);
           });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
