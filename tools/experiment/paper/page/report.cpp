#include "tools/experiment/paper/report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sandhopper::paper {

Study programme_report(const ProgrammeResults& results, const std::vector<Claim>& claims) {
  const auto complete = std::ranges::count(results.hops, true, &HopResult::complete);
  const auto& setup = results.setup;
  Study data;
  data.title = "The paper's programme on the simulator";
  data.verdict = summary(claims);
  data.verdict_mark = std::ranges::count(claims, Verdict::comes_out, &Claim::verdict) ==
                              static_cast<std::ptrdiff_t>(claims.size())
                          ? "good"
                          : "partly";
  data.facts = {{"paper", "arXiv 2604.02563"},
                {"hops", fmt::format("{} ({} with a liftoff)", results.hops.size(), complete)},
                {"seeds", std::to_string(setup.seeds)},
                {"actuator strokes", std::to_string(results.actuator.size())},
                {"bed", fmt::format("{:g} N/m", setup.world.terrain.stiffness_N_per_m)},
                {"observer gain", fmt::format("{:g} 1/s", setup.cycle.estimator.observer_gain_per_s)}};
  data.sections = {claims_section(claims),         stride_section(results),     actuator_section(results),
                   decomposition_section(results), estimation_section(results), stiffness_section(results)};
  return data;
}

}  // namespace sandhopper::paper
