#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

const EffectRegistration kEffect(
    {.id = "imu.lag",
     .port = Port::sensor,
     .statement = "{channel} follows with a lag of first or second order.",
     .equation = "tau1 tau2 y'' + (tau1 + tau2) y' + y = x, tau1 + tau2 = lag",
     .bench_tests =
         {{.kind = "tap",
           .sentence = "Tap the {robot} with a hammer: {channel} shows the blow smeared and late if it lags, "
                       "late but sharp if its time stamps are, and on time if a force is the cause."}},
     .plants = {PlantKind::falling_body, PlantKind::hopper},
     .channels = accelerometers,
     .parameters = [](const Context&, const std::string&) { return lag_parameters(); },
     .apply = [](const Context&, const std::string& channel, std::span<const double> v,
                 Edits& edits) { add_lag(edits, channel, v); }});

}  // namespace
}  // namespace sandhopper::diagnose
