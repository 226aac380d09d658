#include "tools/diagnose/effects/common.hpp"

namespace sandhopper::diagnose {
namespace {

std::vector<EffectParameter> parameters(const Context& c, const std::string&) {
  const double believed = c.belief.value("robot.upper_link_length_m", 0.12);
  return {{.name = "upper_link_length_m",
           .typical = 1e-3,
           .low = -0.02,
           .high = 0.02,
           .either_sign = true,
           .base = believed}};
}

const EffectRegistration kEffect(
    {.id = "leg.geometry",
     .port = Port::geometry,
     .statement = "The upper links have another length than believed.",
     .equation = "l_1 -> l_1 + dl",
     .bench_tests = {{.sentence =
                          "Measure the links from joint to joint with callipers: a wrong length shows there, "
                          "while an offset of an encoder or of a height leaves the links as they are."}},
     .plants = {PlantKind::hopper},
     .parameters = parameters,
     .apply = [](const Context&, const std::string&, std::span<const double> v,
                 Edits& edits) { edits.add("robot.upper_link_length_m", v[0]); },
     .belief_key = "robot.upper_link_length_m"});

}  // namespace
}  // namespace sandhopper::diagnose
