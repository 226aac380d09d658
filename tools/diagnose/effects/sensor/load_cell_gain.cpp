#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "load_cell.gain",
     .port = Port::sensor,
     .statement = "The load cell reads in proportion too much or too little.",
     .equation = "y = (1 + g) F",
     .bench_tests =
         {{.kind = "hold",
           .sentence =
               "Put two known weights on the load cell, one after the other: a wrong gain errs in proportion "
               "to the weight, an offset by the same force; {robot} and bed have no effect."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .channels = load_cells,
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{
               {.name = "gain_error", .typical = 0.03, .low = -0.5, .high = 1.0, .either_sign = true}};
         },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { edits.sensor(channel, SensorEdit::Kind::gain, 1.0 + v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
