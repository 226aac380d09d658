#include "tools/terrain/leg_identification.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "terrain/none.hpp"
#include "tools/terrain/leg_forces.hpp"

namespace sandhopper {
namespace {

std::vector<const HopEquations*> pointers(const std::vector<HopEquations>& equations) {
  std::vector<const HopEquations*> out;
  out.reserve(equations.size());
  for (const auto& e : equations) out.push_back(&e);
  return out;
}

// Root mean square error over hops, each predicted from the others.
double leave_one_hop_out_N(const std::vector<HopEquations>& equations, LinearModel model) {
  double sum = 0.0;
  for (std::size_t left_out = 0; left_out < equations.size(); ++left_out) {
    auto rest = pointers(equations);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    sum += mean_square(equations[left_out], solve(rest, model));
  }
  return std::sqrt(sum / static_cast<double>(equations.size()));
}

LegParameterValues values_of(const LinearFit& fit) {
  return {fit.value(0), fit.value(1), fit.value(2), fit.value(3), fit.clock_offset_s};
}

LinearModel model_of(const LegIdentification& found) {
  return found.has_spring ? LinearModel::friction_and_spring : LinearModel::friction;
}

void bootstrap(const std::vector<HopEquations>& equations, const LegIdentificationOptions& options,
               LegIdentification& out) {
  std::mt19937_64 rng(options.seed);
  std::array<std::vector<double>, kLegParameters> replicates;
  std::vector<double> foot, spring;
  for (std::size_t draw = 0; draw < options.bootstrap; ++draw) {
    std::vector<const HopEquations*> drawn;
    for (std::size_t i = 0; i < equations.size(); ++i) drawn.push_back(&equations[rng() % equations.size()]);
    const auto fit = solve(drawn, model_of(out));
    const auto values = values_of(fit);
    spring.push_back(fit.value(6));
    for (std::size_t i = 0; i < kLegParameters; ++i) replicates[i].push_back(values[i]);
    foot.push_back(solve(drawn, LinearModel::friction_and_foot).value(4));
  }
  for (std::size_t i = 0; i < kLegParameters; ++i) out.interval[i] = percentile_interval(replicates[i]);
  out.foot_mass_interval = percentile_interval(foot);
  out.spring_stiffness_interval = percentile_interval(spring);
}

bool counts(const PreparedHop& prepared, std::size_t row, LegWindow window) {
  if (!(prepared.hop->stance[row] > 0.0)) return false;
  switch (window) {
    case LegWindow::settled:
      return prepared.settled[row];
    case LegWindow::contact:
      return in_settled_stance(prepared, row, 0.0);
    case LegWindow::controller:
      return true;
  }
  return false;
}

template <class Counts>
double rms_where(const std::vector<double>& estimate, const std::vector<double>& reference, Counts&& counts) {
  double squares = 0.0, rows = 0.0;
  for (std::size_t row = 0; row < estimate.size(); ++row)
    if (counts(row)) {
      squares += (estimate[row] - reference[row]) * (estimate[row] - reference[row]);
      rows += 1.0;
    }
  return rows > 0.0 ? std::sqrt(squares / rows) : kNone;
}

std::vector<double> reference_of(const PreparedHop& prepared, double offset_s, double window_s) {
  std::vector<double> out;
  for (const double t : prepared.hop->t_s) out.push_back(reference_at_N(prepared, t + offset_s, window_s));
  return out;
}

LegHopFit score(const PreparedHop& prepared, const LegIdentification& found,
                const LegIdentificationOptions& options) {
  const auto& hop = *prepared.hop;
  LegHopFit out;
  out.trial = hop.trial;
  out.held_out = hop.held_out;
  out.landing_s = prepared.landing_s - hop.t_s.front();
  out.reference_N = reference_of(prepared, found.value[4], options.reference_window_s);
  auto causal = causal_forces(hop, found.observer_gain_per_s, found, options);
  out.force_N = {quasi_static_force(hop), smooth_force(prepared, found, options),
                 std::move(causal.joint_row_N), std::move(causal.reduced_row_N)};
  // The quasi-static estimate uses no clock offset.
  const auto plain = reference_of(prepared, 0.0, options.reference_window_s);
  for (std::size_t form = 0; form < kLegForceForms; ++form)
    for (std::size_t window = 0; window < kLegWindows; ++window)
      out.rms_N[form][window] =
          rms_where(out.force_N[form], form == 0 ? plain : out.reference_N,
                    [&](std::size_t row) { return counts(prepared, row, static_cast<LegWindow>(window)); });
  out.observer_without_delay_N =
      rms_where(out.force_N[2], behind_lag(out.reference_N, hop.t_s, found.observer_gain_per_s),
                [&](std::size_t row) { return prepared.settled[row]; });
  for (std::size_t row = 0; row < hop.t_s.size(); ++row) {
    out.t_s.push_back(hop.t_s[row] - hop.t_s.front());
    out.rate_radps.push_back(prepared.state[row].rate_radps);
    out.settled.push_back(prepared.settled[row]);
  }
  return out;
}

// Over a cycle that ends as it began, the impulse equals weight times duration.
double mass_of_kg(const PreparedHop& prepared) {
  const auto& hop = *prepared.hop;
  const double duration_s = hop.t_s.back() - hop.t_s.front();
  const bool lands = prepared.landing_s > hop.t_s.front() && !std::isinf(prepared.landing_s);
  if (!lands || !(duration_s > 0.0)) return kNone;
  return (prepared.reference_integral_Ns.back() - prepared.reference_integral_Ns.front()) /
         (kGravity_mps2 * duration_s);
}

double best_gain(const std::vector<PreparedHop>& fit_hops, const LegIdentification& found,
                 const LegIdentificationOptions& options) {
  double best = options.observer_gains_per_s.front(), least = std::numeric_limits<double>::infinity();
  for (const double gain : options.observer_gains_per_s) {
    double sum = 0.0;
    for (const auto& prepared : fit_hops) {
      const auto force = causal_forces(*prepared.hop, gain, found, options).joint_row_N;
      const auto reference = reference_of(prepared, found.value[4], options.reference_window_s);
      sum += std::pow(rms_where(force, reference, [&](std::size_t row) { return prepared.settled[row]; }), 2);
    }
    if (sum < least) {
      least = sum;
      best = gain;
    }
  }
  return best;
}

std::vector<PreparedHop> prepare(std::span<const LegHop> hops, bool held_out, double half_width_s,
                                 double tare_N, const LegIdentificationOptions& options) {
  std::vector<PreparedHop> out;
  for (const auto& hop : hops)
    if (hop.held_out == held_out) out.push_back(prepare_hop(hop, half_width_s, tare_N, options));
  return out;
}

std::vector<HopEquations> all_equations(const std::vector<PreparedHop>& hops,
                                        const LegIdentificationOptions& options) {
  std::vector<HopEquations> out;
  for (const auto& hop : hops)
    if (std::count(hop.settled.begin(), hop.settled.end(), true) > 0)
      out.push_back(equations_of(hop, options));
  return out;
}

}  // namespace

double LegIdentification::observer_without_delay_N(bool held_out) const {
  double sum = 0.0, count = 0.0;
  for (const auto& hop : hops)
    if (hop.held_out == held_out) {
      sum += hop.observer_without_delay_N * hop.observer_without_delay_N;
      count += 1.0;
    }
  return count > 0.0 ? std::sqrt(sum / count) : kNone;
}

double LegIdentification::rms_N(LegForceForm form, LegWindow window, bool held_out) const {
  double sum = 0.0, count = 0.0;
  for (const auto& hop : hops) {
    const double rms = hop.rms_N[static_cast<std::size_t>(form)][static_cast<std::size_t>(window)];
    if (hop.held_out != held_out || std::isnan(rms)) continue;
    sum += rms * rms;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : kNone;
}

LegIdentification identify_leg(std::span<const LegHop> hops, const LegIdentificationOptions& options) {
  LegIdentification out;
  out.tare_N = plate_tare_N(hops);
  double least = std::numeric_limits<double>::infinity();
  for (const double half_width_s : options.half_widths_s) {
    const auto equations = all_equations(prepare(hops, false, half_width_s, out.tare_N, options), options);
    if (equations.size() < 2) throw std::invalid_argument("fewer than two hops to identify the leg from");
    const double rms = leave_one_hop_out_N(equations, LinearModel::friction);
    out.cross_validation_N.emplace_back(half_width_s, rms);
    if (rms < least) {
      least = rms;
      out.half_width_s = half_width_s;
    }
  }
  const auto fit_hops = prepare(hops, false, out.half_width_s, out.tare_N, options);
  const auto equations = all_equations(fit_hops, options);
  out.with_spring_N = leave_one_hop_out_N(equations, LinearModel::friction_and_spring);
  out.has_spring = out.with_spring_N < (1.0 - options.spring_gain) * least;
  const auto fit = solve(pointers(equations), model_of(out));
  out.value = values_of(fit);
  out.spring_torque_Nm = fit.value(5);
  out.spring_stiffness_Nm_per_rad = fit.value(6);
  out.foot_mass_kg = solve(pointers(equations), LinearModel::friction_and_foot).value(4);
  bootstrap(equations, options, out);
  std::vector<double> masses;
  masses.reserve(fit_hops.size());
  for (const auto& prepared : fit_hops) masses.push_back(mass_of_kg(prepared));
  out.mass_kg = mean_over_trials(masses);
  out.observer_gain_per_s = best_gain(fit_hops, out, options);
  out.fit_hops = fit_hops.size();
  out.believed_mass_kg = bare_leg(hops.front().leg).total_mass_kg();

  // Nothing is fitted after this point.
  for (const auto& prepared : fit_hops) out.hops.push_back(score(prepared, out, options));
  const auto held_out = prepare(hops, true, out.half_width_s, out.tare_N, options);
  for (const auto& prepared : held_out) out.hops.push_back(score(prepared, out, options));
  out.held_out_hops = held_out.size();
  for (const double settling_s : {0.0, 0.005, 0.010, 0.015, 0.020, 0.030}) {
    double sum = 0.0;
    for (std::size_t i = 0; i < held_out.size(); ++i) {
      const auto& fit = out.hops[fit_hops.size() + i];
      sum += std::pow(
          rms_where(fit.force_N[1], fit.reference_N,
                    [&](std::size_t row) { return in_settled_stance(held_out[i], row, settling_s); }),
          2);
    }
    if (!held_out.empty())
      out.settling_rms_N.emplace_back(settling_s, std::sqrt(sum / static_cast<double>(held_out.size())));
  }
  return out;
}

}  // namespace sandhopper
