#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "terrain/stiffness_fit.hpp"
#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

constexpr auto kQs = static_cast<std::size_t>(Treatment::quasi_static_ols);
constexpr auto kMo = static_cast<std::size_t>(Treatment::observer_ols);
constexpr auto kWls = static_cast<std::size_t>(Treatment::observer_wls);

const CaseResult& case_of(const ProgrammeResults& r, std::string_view name) {
  for (const auto& c : r.treatments.cases)
    if (c.definition.name == name) return c;
  throw std::out_of_range("no treatment case of that name");
}

// mean ratio - 1| of a treatment over the cells of one speed in case A, mean over seeds.
double error_at_speed(const CaseResult& c, double speed_mps, std::size_t treatment) {
  std::vector<double> errors;
  for (const auto& seed : c.ratio)
    for (std::size_t cell = 0; cell < seed.size(); ++cell)
      if (hop_cells()[cell].touchdown_speed_mps == speed_mps && std::isfinite(seed[cell][treatment]))
        errors.push_back(std::abs(seed[cell][treatment] - 1.0));
  return mean(errors);
}

Claim observer_is_close(const ProgrammeResults& r) {
  Claim c{31, "The momentum observer stays close to the load cell through the stride",
          "rms at most 0.4 of the quasi-static one's in every cell"};
  double worst = 0.0;
  for (std::size_t cell = 0; cell < hop_cells().size(); ++cell) {
    EstimationErrors e;
    for (const auto& hop : r.hops)
      if (hop.complete && hop.cell == cell) e.add(hop.errors);
    if (e.cycles > 0.0) worst = std::max(worst, e.observer_to_cell_N.rms() / e.quasi_static_to_cell_N.rms());
  }
  const auto all = errors_of_all(r);
  c.figures = {{"observer against the load cell, rms", all.observer_to_cell_N.rms(), "N", 2},
               {"quasi-static against the load cell, rms", all.quasi_static_to_cell_N.rms(), "N", 2},
               {"load cell against the true force, rms", all.load_cell_N.rms(), "N", 2},
               {"largest ratio of a cell", worst, "", 3}};
  c.verdict = comes_out_if(worst <= 0.4);
  c.why = "what remains of the observer is its own lag at the edges";
  return c;
}

Claim quasi_static_is_curved(const ProgrammeResults& r) {
  const auto trials = complete_trials(r);
  const double share =
      share_of(trials, [](const HopResult& h) { return h.quasi_static_r_squared < h.observer_r_squared; });
  Claim c{32, "Quasi-static force against depth is strongly nonlinear",
          "⟦R^2⟧ of a straight line: quasi-static below observer"};
  c.figures = {{"trials in which it holds", 100.0 * share, "%", 1},
               {"⟦R^2⟧ quasi-static, mean",
                mean(over(trials, [](const HopResult& h) { return h.quasi_static_r_squared; })), "", 3},
               {"⟦R^2⟧ observer, mean",
                mean(over(trials, [](const HopResult& h) { return h.observer_r_squared; })), "", 3}};
  c.verdict = verdict_of_share(share);
  c.why = "samples of the penetration faster than the firmware's threshold";
  return c;
}

Claim observer_beats_quasi_static(const ProgrammeResults& r) {
  Claim c{33,
          "The observer's stiffness is closer to ⟦k_GT⟧ than the quasi-static one, over speed and stiffness",
          "mean ⟦|k / k_GT - 1|⟧ over the cells smaller in at least 7 of 8 seeds; cases A, A2, B and C"};
  bool passed = true;
  for (const std::string_view name : {"A", "A2", "B", "C"}) {
    const auto& one = case_of(r, name);
    const double seeds = static_cast<double>(one.error_by_seed.size());
    const double ordered = one.seeds_in_order(Treatment::quasi_static_ols, Treatment::observer_ols);
    c.figures.push_back(
        {fmt::format("case {}: seeds in which it is smaller", name), 100.0 * ordered / seeds, "%", 0});
    passed = passed && ordered >= 7.0 / 8.0 * seeds;
  }
  const auto error = case_of(r, "A").mean_error();
  c.figures.push_back({"case A: quasi-static, OLS", error[kQs], "", 3});
  c.figures.push_back({"case A: observer, OLS", error[kMo], "", 3});
  c.verdict = comes_out_if(passed);
  c.why = "in every window; but through the origin most of the quasi-static error is the missing foot weight";
  return c;
}

Claim deviation_at_speed(const ProgrammeResults& r) {
  const auto& a = case_of(r, "A");
  const double slow = error_at_speed(a, 0.2, kMo);
  const double fast = error_at_speed(a, 1.2, kMo);
  Claim c{34, "At high speed deviations remain", "observer's error at 1.2 m/s above that at 0.2 m/s"};
  c.figures = {{"0.2 m/s", slow, "", 3}, {"1.2 m/s", fast, "", 3}};
  c.verdict = comes_out_if(fast > slow);
  c.why = "drag lifts the shallow end of the curve and lowers its slope";
  return c;
}

// Further conditions under which the weights lose in case A, and the gain that remains without the added-mass
// force that they are meant to suppress.
std::string other_conditions(const ProgrammeResults& r) {
  std::string lost, cause;
  for (const auto& condition : r.conditions) {
    const auto& error = condition.penetrating;
    if (error[kWls] > error[kMo]) lost += (lost.empty() ? "" : ", ") + condition.name;
    if (condition.name == kNoAddedMassForce)
      cause = fmt::format(
          " Added mass is not the cause: without its force in the bed, drag kept, the gain is {:.3f} to "
          "{:.3f}.",
          error[kMo], error[kWls]);
  }
  return lost.empty() ? cause : fmt::format(" It is lost in case A too with: {}.{}", lost, cause);
}

Claim weighting_helps(const ProgrammeResults& r) {
  Claim c{35, "Weighted regression tracks ⟦k_GT⟧, a substantial improvement",
          "smaller error than the observer's OLS in at least 6 of 8 seeds, in every window"};
  int windows = 0, better = 0;
  std::string where;
  for (const auto& one : r.treatments.cases) {
    const auto error = one.mean_error();
    const double seeds = static_cast<double>(one.error_by_seed.size());
    const double ordered = one.seeds_in_order(Treatment::observer_ols, Treatment::observer_wls);
    const auto name = one.definition.name;
    c.figures.push_back({fmt::format("case {}: observer, OLS", name), error[kMo], "", 3});
    c.figures.push_back({fmt::format("case {}: observer, weighted", name), error[kWls], "", 3});
    c.figures.push_back(
        {fmt::format("case {}: seeds in which it is smaller", name), 100.0 * ordered / seeds, "%", 0});
    ++windows;
    if (ordered < 6.0 / 8.0 * seeds) continue;
    ++better;
    where += (where.empty() ? "" : ", ") + std::string(name);
  }
  c.verdict = better == windows ? Verdict::comes_out : better > 0 ? Verdict::only_if : Verdict::does_not;
  const auto base = case_of(r, "A").mean_error();
  c.why = fmt::format(
      "the slow samples of the plateau are left out and the line has an intercept: it is better in {} and "
      "worse in the other windows, where the weights fall on the plateau. In case A it takes off {:.0f} % "
      "of the error.{}",
      where.empty() ? "no window" : where, 100.0 * (1.0 - base[kWls] / base[kMo]), other_conditions(r));
  return c;
}

Claim weight_formula(const ProgrammeResults& r) {
  const auto& w = r.setup.cycle.stiffness.weights;
  const auto sigma_at = [&](double accel_mps2) {
    return 1.0 / std::sqrt(acceleration_weight(w, accel_mps2));
  };
  const double half = (sigma_at(w.threshold_mps2) - w.sigma_good_N) / (w.sigma_bad_N - w.sigma_good_N);
  const double ratio = acceleration_weight(w, 0.0) / acceleration_weight(w, 1e3);
  const double expected = std::pow(w.sigma_bad_N / w.sigma_good_N, 2);
  bool monotone = true;
  for (int i = 0; i < 1000; ++i)
    monotone = monotone && acceleration_weight(w, 0.1 * i) >= acceleration_weight(w, 0.1 * (i + 1));
  Claim c{36, "Weights ⟦1 / sigma_i^2⟧ with a logistic ⟦s⟧ of the acceleration",
          "⟦s(a_0) = 0.5⟧; falling throughout; ratio of weights ⟦(sigma_bad / sigma_good)^2⟧ within 10 %"};
  c.figures = {{"⟦s(a_0)⟧", half, "", 4},
               {"ratio of weights", ratio, "", 1},
               {"⟦(sigma_bad / sigma_good)^2⟧", expected, "", 1}};
  c.verdict = comes_out_if(std::abs(half - 0.5) < 1e-9 && monotone && std::abs(ratio / expected - 1.0) < 0.1);
  c.why = "at rest ⟦s⟧ is not quite 0, so the ratio is not quite reached";
  return c;
}

}  // namespace

std::vector<Claim> stiffness_claims(const ProgrammeResults& results) {
  return {observer_is_close(results),  quasi_static_is_curved(results), observer_beats_quasi_static(results),
          deviation_at_speed(results), weighting_helps(results),        weight_formula(results)};
}

}  // namespace sandhopper::paper
