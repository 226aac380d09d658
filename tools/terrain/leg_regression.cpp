#include "tools/terrain/leg_regression.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimation/local_polynomial.hpp"

namespace sandhopper {
namespace {

constexpr int kOffsetsEachSide = 20;
constexpr double kOffsetStep_s = 0.25e-3;

// 1 for each term that the model has.
LinearValues terms_of(LinearModel model) {
  LinearValues terms;
  terms << 1, 1, 1, 1, model == LinearModel::friction_and_foot ? 1 : 0,
      model == LinearModel::friction_and_spring ? 1 : 0, model == LinearModel::friction_and_spring ? 1 : 0;
  return terms;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Plate readings in the second half of the flight at the end of the hop.
std::vector<double> in_late_flight(const LegHop& hop) {
  std::size_t last_stance = 0;
  for (std::size_t i = 0; i < hop.t_s.size(); ++i)
    if (hop.stance[i] > 0.0) last_stance = i;
  const double from_s = 0.5 * (hop.t_s[last_stance] + hop.t_s.back());
  std::vector<double> out;
  for (std::size_t i = 0; i < hop.reference_t_s.size(); ++i)
    if (hop.reference_t_s[i] > from_s) out.push_back(hop.reference_N[i]);
  return out;
}

double interpolated(std::span<const double> x, std::span<const double> y, double at) {
  const auto above = static_cast<std::size_t>(std::lower_bound(x.begin(), x.end(), at) - x.begin());
  if (above == 0) return y.front();
  if (above == x.size()) return y.back();
  const double share = (at - x[above - 1]) / (x[above] - x[above - 1]);
  return y[above - 1] + share * (y[above] - y[above - 1]);
}

// Time of the first plate reading above the threshold, or of the first row if the hop starts in contact.
double landing_of(const LegHop& hop, double tare_N, double contact_force_N) {
  const auto at_start_N = hop.reference_N.front() - tare_N;
  if (at_start_N > 0.25 * contact_force_N) return hop.t_s.front();
  for (std::size_t i = 0; i < hop.reference_t_s.size(); ++i)
    if (hop.reference_N[i] - tare_N > contact_force_N) return hop.reference_t_s[i];
  return std::numeric_limits<double>::infinity();
}

}  // namespace

double plate_tare_N(std::span<const LegHop> hops) {
  std::vector<double> per_hop;
  for (const auto& hop : hops)
    if (!hop.held_out) per_hop.push_back(median(in_late_flight(hop)));
  std::erase_if(per_hop, [](double value) { return std::isnan(value); });
  return per_hop.empty() ? 0.0 : median(per_hop);
}

PreparedHop prepare_hop(const LegHop& hop, double half_width_s, double tare_N,
                        const LegIdentificationOptions& options) {
  PreparedHop out;
  out.hop = &hop;
  out.landing_s = landing_of(hop, tare_N, options.contact_force_N);
  for (const auto& fit : local_polynomial(hop.t_s, hop.angle_rad, half_width_s))
    out.state.push_back({fit.value, fit.rate, fit.acceleration});
  out.reference_integral_Ns.assign(hop.reference_t_s.size(), 0.0);
  for (std::size_t i = 1; i < hop.reference_t_s.size(); ++i)
    out.reference_integral_Ns[i] =
        out.reference_integral_Ns[i - 1] + (0.5 * (hop.reference_N[i] + hop.reference_N[i - 1]) - tare_N) *
                                               (hop.reference_t_s[i] - hop.reference_t_s[i - 1]);
  for (std::size_t row = 0; row < hop.t_s.size(); ++row)
    out.settled.push_back(in_settled_stance(out, row, hop.contact_settling_s));
  return out;
}

double reference_at_N(const PreparedHop& prepared, double t_s, double window_s) {
  const auto& x = prepared.hop->reference_t_s;
  const auto& y = prepared.reference_integral_Ns;
  const double from_s = std::clamp(t_s - window_s, x.front(), x.back() - 2.0 * window_s);
  const double to_s = std::clamp(t_s + window_s, x.front() + 2.0 * window_s, x.back());
  return (interpolated(x, y, to_s) - interpolated(x, y, from_s)) / (to_s - from_s);
}

bool in_settled_stance(const PreparedHop& prepared, std::size_t row, double settling_s) {
  return prepared.hop->stance[row] > 0.0 && prepared.hop->t_s[row] > prepared.landing_s + settling_s;
}

std::vector<double> clock_offsets_s() {
  std::vector<double> out;
  for (int i = -kOffsetsEachSide; i <= kOffsetsEachSide; ++i) out.push_back(i * kOffsetStep_s);
  return out;
}

Leg bare_leg(const LegParameters& believed) {
  LegParameters p = believed;
  p.rotor_inertia_kg_m2 = 0.0;
  if (p.body_mass_kg <= 0.0) p.body_mass_kg = 1.0;  // any value: it cancels in the joint row
  return Leg{p};
}

LinearValues regressors(const Leg& leg, const JointState& state, double torque_Nm, double switch_radps) {
  const double dl = leg.kinematics(state.angle_rad).dlength_m_per_rad;
  LinearValues x;
  x << torque_Nm / dl, -state.accel_radps2 / dl, -std::tanh(state.rate_radps / switch_radps) / dl,
      -state.rate_radps / dl, kGravity_mps2, 1.0 / dl, -state.angle_rad / dl;
  return x;
}

HopEquations equations_of(const PreparedHop& prepared, const LegIdentificationOptions& options) {
  const auto& hop = *prepared.hop;
  const Leg leg = bare_leg(hop.leg);
  const auto offsets = clock_offsets_s();
  HopEquations out;
  out.right.assign(offsets.size(), LinearValues::Zero());
  out.squares.assign(offsets.size(), 0.0);
  const auto rows = static_cast<double>(std::count(prepared.settled.begin(), prepared.settled.end(), true));
  for (std::size_t row = 0; row < hop.t_s.size(); ++row) {
    if (!prepared.settled[row]) continue;
    const auto& state = prepared.state[row];
    const auto x = regressors(leg, state, hop.torque_Nm[row], options.friction_switch_radps);
    const double known_N = joint_row_force_N(leg, state, 0.0);
    out.normal += x * x.transpose() / rows;
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      const double y =
          reference_at_N(prepared, hop.t_s[row] + offsets[i], options.reference_window_s) - known_N;
      out.right[i] += x * (y / rows);
      out.squares[i] += y * y / rows;
    }
  }
  return out;
}

LinearFit solve(std::span<const HopEquations* const> hops, LinearModel model) {
  const auto terms = terms_of(model);
  NormalMatrix normal = NormalMatrix::Zero();
  for (const auto* hop : hops) normal += hop->normal;
  normal = terms.asDiagonal() * normal * terms.asDiagonal();
  normal.diagonal() += LinearValues::Ones() - terms;
  const Eigen::LDLT<NormalMatrix> factors(normal);
  const auto offsets = clock_offsets_s();
  LinearFit best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    LinearFit fit;
    fit.clock_offset_s = offsets[i];
    LinearValues right = LinearValues::Zero();
    double squares = 0.0;
    for (const auto* hop : hops) {
      right += hop->right[i];
      squares += hop->squares[i];
    }
    fit.value = factors.solve(right.cwiseProduct(terms));
    const double error = squares - fit.value.dot(right);
    if (error < least) {
      least = error;
      best = fit;
    }
  }
  return best;
}

double mean_square(const HopEquations& hop, const LinearFit& fit) {
  const auto offsets = clock_offsets_s();
  const auto i = static_cast<std::size_t>(
      std::lower_bound(offsets.begin(), offsets.end(), fit.clock_offset_s - 1e-9) - offsets.begin());
  return hop.squares[i] - 2.0 * fit.value.dot(hop.right[i]) + fit.value.dot(hop.normal * fit.value);
}

}  // namespace sandhopper
