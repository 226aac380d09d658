#include <fmt/format.h>

#include <cmath>

#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/paper/estimator_checks.hpp"
#include "tools/experiment/paper/leg_checks.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {
namespace {

Claim quasi_static_force(const ProgrammeResults& r) {
  const auto leg = standing_leg(r.setup.world);
  const double ratio = leg.quasi_static_N / leg.spring_N - 1.0;
  const double missing_N = leg.contact_N - leg.quasi_static_N;
  const double gap = missing_N / leg.reduced_weight_N - 1.0;
  Claim c{
      3, "Without motion the leg's force is ⟦F = J^-T tau⟧",
      "standing leg: ⟦tau / L'⟧ is the leg's force within 1 %, and the ground's force exceeds it by ⟦M_f g⟧ "
      "within 1 %"};
  c.figures = {{"⟦tau / L'⟧ against the leg's spring", 100.0 * ratio, "%", 3},
               {"ground's force less ⟦tau / L'⟧", missing_N, "N", 3},
               {"⟦M_f g⟧", leg.reduced_weight_N, "N", 3}};
  c.verdict = comes_out_if(std::abs(ratio) < 0.01 && std::abs(gap) < 0.01);
  c.why = fmt::format("it is the leg's force, not the ground's: {:.2f} N of foot and link weight are missing",
                      missing_N);
  return c;
}

Claim equation_of_motion(const ProgrammeResults& r) {
  const double difference = mass_matrix_difference(r.setup.world.robot.leg);
  Claim c{4, "The leg's equation of motion is ⟦M q'' + C q' + g = S^T tau + J_c^T F⟧",
          "mass matrix and derivative equal those of the links' kinetic energy within 1e-9"};
  c.figures = {{"largest difference", difference, "SI", 15}};
  c.verdict = comes_out_if(difference < 1e-9);
  c.why =
      "compared over the leg's range with matrices from the links' places, differentiated by complex steps";
  return c;
}

Claim reduced_equation(const ProgrammeResults& r) {
  const double residual_N = reduced_equation_residual_N(r.setup.world.robot.leg);
  Claim c{5, "The foot alone obeys ⟦M_f (x'' + g) = F_c - beta tau - C phi'^2⟧",
          "accelerations of the full equation leave a residual below 1e-9 N"};
  c.figures = {{"largest residual", residual_N, "N", 15}};
  c.verdict = comes_out_if(residual_N < 1e-9);
  c.why = "both rows solved for random states, forces and torques, then put into the reduced equation";
  return c;
}

Claim massless_limit(const ProgrammeResults& r) {
  const auto accel =
      over(complete_trials(r), [](const HopResult& h) { return h.shape.touchdown_transient_mps2; });
  const auto remainder = massless_remainder(r.setup.world.robot.leg, mean(accel));
  Claim c{6, "Without link inertia the dynamic estimate is the quasi-static one",
          "⟦F_c - tau / L'⟧ vanishes for links and rotors without inertia"};
  c.figures = {{"mean foot acceleration after touchdown", mean(accel), "m/s²", 1},
               {"⟦F_c - tau / L'⟧ then", remainder.remainder_N, "N", 2},
               {"⟦m_f (x'' + g)⟧", remainder.foot_inertia_N, "N", 2}};
  const bool is_foot = std::abs(remainder.remainder_N - remainder.foot_inertia_N) < 1e-9;
  c.verdict = std::abs(remainder.remainder_N) < 0.01 * remainder.foot_inertia_N ? Verdict::comes_out
                                                                                : Verdict::does_not;
  c.why =
      fmt::format("the foot's own weight and inertia ⟦m_f (x'' + g)⟧ remain{}: {:.1f} N while it is stopped",
                  is_foot ? ", exactly" : "", remainder.remainder_N);
  return c;
}

Claim momentum_rate(const ProgrammeResults& r) {
  const auto balance = momentum_balance(r.setup.world);
  Claim c{7, "The ground's force is ⟦F_c = p' - psi⟧", "differentiated simulation within 0.1 N at 0.1 ms"};
  c.figures = {{"largest difference", balance.largest_N, "N", 4}, {"rms", balance.rms_N, "N", 5}};
  c.verdict = comes_out_if(balance.largest_N < 0.1);
  c.why = "mean force of each 0.1 ms of a hop without friction, release to liftoff";
  return c;
}

Claim observer_law(const ProgrammeResults& r) {
  const auto step = observer_step(r.setup.cycle.estimator.observer_gain_per_s);
  const double error = step.time_constant_s / step.expected_s - 1.0;
  Claim c{8, "The observer's law is ⟦r' = k (F_c - r)⟧, also in its internal form",
          "step response with time constant ⟦1 / k⟧ within 2 %"};
  c.figures = {{"time constant", 1e3 * step.time_constant_s, "ms", 4},
               {"⟦1 / k⟧", 1e3 * step.expected_s, "ms", 4},
               {"largest difference from the internal form", 100.0 * step.internal_form_difference,
                "% of the step", 4}};
  c.verdict = comes_out_if(std::abs(error) < 0.02 && step.internal_form_difference < 0.01);
  c.why = "the cycle's exact update at 1 kHz against ⟦r = k (p - integral (psi + r) dt)⟧ in steps of 1 µs";
  return c;
}

}  // namespace

std::vector<Claim> mechanics_claims(const ProgrammeResults& results) {
  return {quasi_static_force(results), equation_of_motion(results), reduced_equation(results),
          massless_limit(results),     momentum_rate(results),      observer_law(results)};
}

}  // namespace sandhopper::paper
