#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "sensor.lag",
     .port = Port::sensor,
     .statement = "{channel} follows with a lag of first or second order.",
     .equation = "tau1 tau2 y'' + (tau1 + tau2) y' + y = x, tau1 + tau2 = lag",
     .bench_tests =
         {{.kind = "tap",
           .sentence =
               "Tap the axis with a hammer and compare {channel} with the rate of the recorded angle: a lag "
               "smears the jump and late time stamps shift it whole, while friction does neither."}},
     .plants = {PlantKind::rotary_axis},
     .channels = [](const Context& c) { return present(c, {"velocity_radps"}); },
     .parameters = [](const Context&, const std::string&) { return lag_parameters(); },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { add_lag(edits, channel, v); }});

}  // namespace
}  // namespace sandhopper::diagnose
