#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "load_cell.lag",
     .port = Port::sensor,
     .statement = "The load cell follows with a lag of first or second order.",
     .equation = "tau1 tau2 y'' + (tau1 + tau2) y' + y = F, tau1 + tau2 = lag",
     .bench_tests = {{.kind = "tap",
                      .sentence =
                          "Tap the unloaded load cell with a hammer: a lag smears the peak, late time stamps "
                          "shift it whole; bed, friction and mass of the {foot} have no effect."}},
     .plants = {PlantKind::intruder, PlantKind::hopper},
     .channels = load_cells,
     .parameters = [](const Context&, const std::string&) { return lag_parameters(); },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { add_lag(edits, channel, v); }});

}  // namespace
}  // namespace sandhopper::diagnose
