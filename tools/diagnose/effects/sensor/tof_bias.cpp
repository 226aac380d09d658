#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "tof.bias",
     .port = Port::sensor,
     .statement = "The zero of tof_height_m is not the surface of the bed.",
     .equation = "z_recorded = z + o",
     .bench_tests = {{.kind = "hold",
                      .sentence = "Hold the robot still on two gauge blocks: a bias of tof_height_m is the "
                                  "same at both heights, a wrong scale errs in proportion to the height, and "
                                  "a crust of the bed does not enter."}},
     .plants = {PlantKind::hopper},
     .parameters =
         [](const Context& c, const std::string&) {
           if (!c.has("tof_height_m")) return std::vector<EffectParameter>{};
           return std::vector<EffectParameter>{{.name = "bias_m",
                                                .typical = 1e-3,
                                                .low = -0.03,
                                                .high = 0.03,
                                                .either_sign = true,
                                                .scale = -1.0}};
         },
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.sensor("tof_height_m", SensorEdit::Kind::offset, -v[0]); }});

}  // namespace
}  // namespace sandhopper::diagnose
