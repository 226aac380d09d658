#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "load_cell.inertia",
     .port = Port::sensor,
     .statement = "A mass lies between load cell and contact: the force that accelerates it does not reach "
                  "the load cell.",
     .equation = "y = F - m a",
     .bench_tests =
         {{.kind = "air_sweep",
           .sentence =
               "Move the {foot} fast up and down in the air: a load cell that reads a force in step with the "
               "acceleration carries a mass, because added mass and drag of a bed are not there."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .channels = load_cells,
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "mass_kg", .typical = 0.1, .low = -5.0, .high = 5.0, .either_sign = true}};
         },
     .apply =
         [](const Context&, const std::string&, std::span<const double> v, Edits& edits) {
           const double mass = v[0];
           edits.law(LawPort::load_cell, [mass](const CellState& s) { return -mass * s.foot_accel_mps2; });
         }});

}  // namespace
}  // namespace sandhopper::diagnose
