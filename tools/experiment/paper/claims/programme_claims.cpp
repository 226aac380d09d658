#include <fmt/format.h>

#include <cmath>

#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/paper/sensitivity.hpp"
#include "tools/experiment/paper/setup_checks.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

Claim small_release(const ProgrammeResults& r) {
  const double frictionless = drop_speed_mps(r.setup.world, 0.002, false);
  const double real = drop_speed_mps(r.setup.world, 0.0025, true);
  Claim c{13, "A release from 2 mm touches down at 0.2 m/s",
          "0.198 ± 0.001 m/s without friction; 0.21 ± 0.005 from 2.5 mm with it"};
  c.figures = {{"from 2 mm without friction", frictionless, "m/s", 4},
               {"from 2 mm with rail friction", drop_speed_mps(r.setup.world, 0.002, true), "m/s", 4},
               {"from 2.5 mm with rail friction", real, "m/s", 4}};
  c.verdict = comes_out_if(std::abs(frictionless - 0.198) <= 0.001 && std::abs(real - 0.21) <= 0.005);
  c.why =
      fmt::format("with {:.0f} N on the rail 2 mm are a little short", r.setup.world.robot.rail_coulomb_N);
  return c;
}

Claim touchdown_speeds(const ProgrammeResults& r) {
  Claim c{14, "Touchdown speeds of 0.2 to 1.2 m/s",
          "true speed at contact within 5 % of each of the five targets"};
  double worst = 0.0, worst_target = 0.0;
  for (std::size_t i = 0; i < hop_cells().size(); i += 3) {
    const double target = hop_cells()[i].touchdown_speed_mps;
    const auto speed =
        over(complete_trials(r, [&](const HopCell& cell) { return cell.touchdown_speed_mps == target; }),
             [](const HopResult& h) { return h.shape.touchdown_speed_mps; });
    c.figures.push_back({fmt::format("for {:.2f} m/s", target), mean(speed), "m/s", 3});
    const double error = mean(speed) / target - 1.0;
    if (std::abs(error) > std::abs(worst)) worst = error, worst_target = target;
  }
  c.verdict = std::abs(worst) <= 0.05 ? Verdict::comes_out : Verdict::only_if;
  c.why = fmt::format("the release height suits the rail's friction; the worst is {:+.1f} % at {:.2f} m/s",
                      100.0 * worst, worst_target);
  return c;
}

Claim leg_stiffnesses(const ProgrammeResults& r) {
  Claim c{15, "Extension stiffness 500 N/m, compression 250, 375 and 500 N/m",
          "⟦d F / d L⟧ of the leg within 1 % in each mode, where the torque is not at its limit"};
  double worst = 0.0;
  for (const double set : {250.0, 375.0, 500.0}) {
    const auto found = leg_stiffness(r.setup.cycle, r.setup.world, set);
    c.figures.push_back(
        {fmt::format("compression set to {:.0f} N/m", set), found.compression_N_per_m, "N/m", 1});
    worst = std::max(worst, std::abs(found.compression_N_per_m / set - 1.0));
    if (set != 375.0 || std::isnan(found.extension_N_per_m)) continue;
    const double extension = r.setup.cycle.controller.extension_stiffness_N_per_m;
    c.figures.push_back({"extension", found.extension_N_per_m, "N/m", 1});
    worst = std::max(worst, std::abs(found.extension_N_per_m / extension - 1.0));
  }
  c.verdict = comes_out_if(worst <= 0.01);
  c.why = fmt::format(
      "from the motors' torque against the length the cycle saw; worst {:.2f} %. At the torque limit the "
      "leg pushes with less",
      100.0 * worst);
  return c;
}

Claim trial_count(const ProgrammeResults& r) {
  const auto all = cell_error(r.treatments.cases.front());
  const auto subset = cell_error(r.treatments.cases.front(),
                                 [](const HopCell& cell) { return cell.touchdown_speed_mps != 0.45; });
  const double per_set = static_cast<double>(r.hops.size()) / r.setup.seeds;
  const double complete = static_cast<double>(complete_trials(r).size());
  Claim c{16, "60 trials",
          "5 speeds × 3 stiffnesses × 5 trials are 75; the order of the treatments is the same for 75 and "
          "for 12 cells"};
  c.figures = {{"trials in a set", per_set, "", 0},
               {"trials in all", static_cast<double>(r.hops.size()), "", 0},
               {"of them with a liftoff", complete, "", 0},
               {"mean error, 15 cells: quasi-static, OLS", all[0], "", 3},
               {"15 cells: observer, OLS", all[1], "", 3},
               {"15 cells: observer, weighted", all[2], "", 3},
               {"mean error, 12 cells (without 0.45 m/s): quasi-static, OLS", subset[0], "", 3},
               {"12 cells: observer, OLS", subset[1], "", 3},
               {"12 cells: observer, weighted", subset[2], "", 3}};
  const auto ordered = [](const auto& e) { return e[0] > e[1] && e[1] > e[2]; };
  c.verdict = ordered(all) == ordered(subset) ? Verdict::only_if : Verdict::does_not;
  c.why = fmt::format(
      "12 of the 15 cells are meant: 5 × 3 × 5 is {:.0f}. Which 12 does not matter for the order", per_set);
  return c;
}

}  // namespace

std::vector<Claim> programme_claims(const ProgrammeResults& results) {
  return {small_release(results), touchdown_speeds(results), leg_stiffnesses(results), trial_count(results)};
}

}  // namespace sandhopper::paper
