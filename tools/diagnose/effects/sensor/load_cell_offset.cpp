#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "load_cell.offset",
     .port = Port::sensor,
     .statement = "The load cell reads too much or too little by a constant.",
     .equation = "y = F + o",
     .bench_tests = {{.kind = "hold",
                      .sentence = "Read the load cell with nothing on it before and after a trial: what it "
                                  "shows is its offset, because a gain, suction or a crust needs a load."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .channels = load_cells,
     .parameters =
         [](const Context&, const std::string&) {
           return std::vector<EffectParameter>{{.name = "offset_N",
                                                .typical = 0.5,
                                                .low = -50.0,
                                                .high = 50.0,
                                                .either_sign = true,
                                                .base = 0.0}};
         },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { edits.sensor(channel, SensorEdit::Kind::offset, v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
