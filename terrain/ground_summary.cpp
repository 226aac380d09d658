#include "terrain/ground_summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "terrain/small_gaussian.hpp"

namespace sandhopper {

namespace {

constexpr std::size_t kShape = 4;       // parameters of a model
constexpr std::size_t kDepartures = 4;  // largest number
constexpr std::size_t kOthers = 3;      // intercept, added mass, force scale
constexpr std::size_t kColumns = kShape + kOthers + kDepartures;
constexpr double kPinned = 1e12;
constexpr double kFree = 1e-9;
constexpr std::size_t kAt = kShape;  // column of the intercept; added mass and force scale follow

using Direction = std::array<double, ProfileSolver::kTerms>;

// Least squares over a few directions of the profile, starting from `offset`.
struct Model {
  Direction offset{};
  std::array<Direction, kColumns> direction{};
  std::array<double, kColumns> mean{};
  std::array<double, kColumns> precision{};
  std::size_t departures = 0;

  Model() { precision.fill(kPinned); }
  void use(std::size_t column, const Direction& d, double prior_mean, double prior_precision) {
    direction[column] = d;
    mean[column] = prior_mean;
    precision[column] = prior_precision;
  }
  void pin(std::size_t column, double value) {
    mean[column] = value;
    precision[column] = kPinned;
  }
};

struct Fit {
  std::array<double, kColumns> value{};
  std::array<double, kColumns * kColumns> covariance{};
  double gain = 0.0;  // gain of the log-likelihood over the offset, including the priors
};

Fit solve(const ProfileSolver& solver, const Model& model) {
  constexpr std::size_t n = ProfileSolver::kTerms;
  const auto& k = solver.normal();
  Direction left = solver.moment();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) left[i] -= k[i * n + j] * model.offset[j];
  std::array<double, kColumns * kColumns> normal{};
  std::array<double, kColumns> moment{};
  for (std::size_t a = 0; a < kColumns; ++a) {
    Direction product{};
    for (std::size_t j = 0; j < n; ++j) {  // k is symmetric
      const double share = model.direction[a][j];
      if (share == 0.0) continue;
      for (std::size_t i = 0; i < n; ++i) product[i] += share * k[j * n + i];
    }
    for (std::size_t b = 0; b < kColumns; ++b)
      for (std::size_t i = 0; i < n; ++i) normal[b * kColumns + a] += model.direction[b][i] * product[i];
    for (std::size_t i = 0; i < n; ++i) moment[a] += model.direction[a][i] * left[i];
    normal[a * kColumns + a] += model.precision[a];
    moment[a] += model.precision[a] * model.mean[a];
  }
  const Cholesky<kColumns> root(normal);
  Fit fit{.value = root.solve(moment), .covariance = root.inverse()};
  for (std::size_t a = 0; a < kColumns; ++a)
    fit.gain += 0.5 * (fit.value[a] * moment[a] - model.precision[a] * model.mean[a] * model.mean[a]);
  return fit;
}

// Wald statistic of the departures.
ModelCheck check(const Fit& fit, std::size_t departures) {
  constexpr std::size_t first = kShape + kOthers;
  std::array<double, kDepartures * kDepartures> covariance{};
  std::array<double, kDepartures> value{};
  for (std::size_t i = 0; i < kDepartures; ++i) {
    covariance[i * kDepartures + i] = 1.0;
    if (i >= departures) continue;
    value[i] = fit.value[first + i];
    for (std::size_t j = 0; j < departures; ++j)
      covariance[i * kDepartures + j] = fit.covariance[(first + i) * kColumns + first + j];
  }
  const auto solved = Cholesky<kDepartures>(covariance).solve(value);
  ModelCheck result{.statistic = 0.0,
                    .limit = chi_squared_quantile(static_cast<double>(departures), 2.326348)};
  for (std::size_t i = 0; i < departures; ++i) result.statistic += value[i] * solved[i];
  return result;
}

Direction cells(auto&& of_cell) {
  Direction d{};
  for (std::size_t j = 0; j < kProfileCells; ++j) d[j] = of_cell(j);
  return d;
}

Direction unit(std::size_t term) {
  Direction d{};
  d[term] = 1.0;
  return d;
}

double legendre(std::size_t degree, double x) {
  double before = 1.0, here = x;
  if (degree == 0) return before;
  for (std::size_t n = 1; n < degree; ++n) {
    const double m = static_cast<double>(n);
    const double next = ((2.0 * m + 1.0) * x * here - m * before) / (m + 1.0);
    before = here;
    here = next;
  }
  return here;
}

class Summariser {
 public:
  explicit Summariser(const ProfileSolver& solver)
      : solver_(solver),
        joint_(solver.config().joint),
        believed_(solver.config().profile_or_default().believed_stiffness_N_per_m),
        from_m_(solver.profile().depth_min_m),
        to_m_(std::min(solver.profile().depth_max_m, kProfileDepth_m)) {}

  GroundSummary run() {
    GroundSummary s;
    s.stride = solver_.profile().stride;
    s.from_m = from_m_;
    s.to_m = to_m_;
    double observations = 0.0;
    for (const float n : solver_.profile().observations) observations += n;
    const bool enough = observations >= solver_.config().joint.min_observations &&
                        to_m_ - from_m_ >= solver_.config().min_depth_span_m;
    const auto secant = solver_.force_N(kSecantDepth_m);
    if (to_m_ >= kSecantDepth_m)
      s.secant_20mm_N_per_m = value_of(secant.value, secant.sd, 1.0 / kSecantDepth_m);
    if (!enough) return s;
    line(s);
    power_law(s);
    layers(s);
    s.shape = shape_of(s);
    s.line_valid = s.shape == GroundShape::line && to_m_ <= solver_.config().max_depth_m &&
                   s.line_N_per_m.ci95_low > 0.0;
    return s;
  }

 private:
  static constexpr double kSecantDepth_m = 0.020;

  static SummaryValue value_of(double value, double sd, double scale = 1.0) {
    const ProfilePoint p{scale * value, scale * sd};
    return {p.value, p.low(), p.high()};
  }
  double centre(std::size_t cell) const { return (static_cast<double>(cell) + 0.5) * kProfileCell_m; }

  Model model() const {
    Model m;
    m.use(kAt, unit(ProfileSolver::kIntercept), 0.0, inverse_square(joint_.intercept_depth_sd_m));
    m.use(kAt + 1, unit(ProfileSolver::kAddedMass), joint_.added_mass_factor,
          inverse_square(joint_.added_mass_factor_sd));
    m.use(kAt + 2, unit(ProfileSolver::kScale), 0.0, inverse_square(joint_.force_scale_relative));
    return m;
  }
  static double inverse_square(double sd) { return 1.0 / std::max(sd * sd, 1e-12); }

  void depart(Model& m, std::size_t lowest, std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i)
      m.use(kShape + kOthers + i, cells([&](std::size_t j) {
              const double x = 2.0 * (centre(j) - from_m_) / (to_m_ - from_m_) - 1.0;
              return believed_ * legendre(lowest + i, std::clamp(x, -1.0, 1.0));
            }),
            0.0, kFree);
  }

  // Intercept depth and added mass cannot be negative; negative values are set to zero.
  void hold(Model& m, const Fit& fit) const {
    if (fit.value[kAt] < -joint_.intercept_depth_m) m.pin(kAt, -joint_.intercept_depth_m);
    if (fit.value[kAt + 1] < 0.0) m.pin(kAt + 1, 0.0);
  }

  void line(GroundSummary& s) const {
    Model m = model();
    m.use(0, cells([&](std::size_t) { return believed_; }), 0.0, kFree);
    hold(m, solve(solver_, m));
    const Fit fit = solve(solver_, m);
    const auto joint = solver_.line();
    s.line_N_per_m = std::isfinite(joint.value_N_per_m)
                         ? SummaryValue{joint.value_N_per_m, joint.ci95_low_N_per_m, joint.ci95_high_N_per_m}
                         : value_of(1.0 + fit.value[0], std::sqrt(fit.covariance[0]), believed_);
    depart(m, 1, 4);
    s.line = check(solve(solver_, m), 4);
  }

  // Gauss-Newton fit of F = A z^n, linearised around the present A and n.
  void power_law(GroundSummary& s) const {
    double log_a = std::log(believed_ * 0.02), n = 1.0;  // force at 20 mm
    Model m = model();
    Fit fit;
    constexpr int kPasses = 6;
    for (int pass = 0; pass < kPasses; ++pass) {
      const auto tangent = [&](std::size_t j, double da, double dn) {
        const auto force = [&](double z) { return std::exp(log_a + da) * std::pow(z / 0.02, n + dn); };
        return (force(centre(j) + 0.5 * kProfileCell_m) - force(centre(j) - 0.5 * kProfileCell_m)) /
               kProfileCell_m;
      };
      constexpr double kStep = 1e-4;
      m.offset = cells([&](std::size_t j) {
        return tangent(j, 0.0, 0.0) - solver_.believed_N_per_m(j) +
               joint_.intercept_depth_m * solver_.intercept_N_per_m(j);
      });
      // Remove the believed bed's intercept, also its shape within a cell.
      m.offset[ProfileSolver::kIntercept] = -joint_.intercept_depth_m;
      m.pin(kAt, 0.0);
      m.use(0, cells([&](std::size_t j) { return (tangent(j, kStep, 0.0) - tangent(j, 0.0, 0.0)) / kStep; }),
            0.0, kFree);
      m.use(1, cells([&](std::size_t j) { return (tangent(j, 0.0, kStep) - tangent(j, 0.0, 0.0)) / kStep; }),
            0.0, kFree);
      fit = solve(solver_, m);
      if (pass + 1 == kPasses) break;
      log_a += std::clamp(fit.value[0], -0.5, 0.5);
      n = std::clamp(n + std::clamp(fit.value[1], -0.3, 0.3), 0.2, 4.0);
    }
    if (fit.value[kAt + 1] < 0.0) m.pin(kAt + 1, 0.0);
    s.exponent = value_of(n, std::sqrt(fit.covariance[kColumns + 1]));
    depart(m, 2, 3);
    s.power_law = check(solve(solver_, m), 3);
  }

  // Two stiffnesses with two transition cells between them; the place with the best fit is chosen.
  void layers(GroundSummary& s) const {
    double best = -1e300;
    Model best_model;
    const auto first = static_cast<std::size_t>(from_m_ / kProfileCell_m) + 2;
    const auto last = static_cast<std::size_t>(to_m_ / kProfileCell_m);
    for (std::size_t b = first; b + 3 < last; ++b) {
      Model m = model();
      m.use(0, cells([&](std::size_t j) { return j < b ? believed_ : 0.0; }), 0.0, kFree);
      m.use(1, cells([&](std::size_t j) { return j > b + 1 ? believed_ : 0.0; }), 0.0, kFree);
      m.use(2, unit(b), 0.0, kFree);
      m.use(3, unit(b + 1), 0.0, kFree);
      hold(m, solve(solver_, m));
      const Fit fit = solve(solver_, m);
      if (fit.gain <= best) continue;
      best = fit.gain;
      best_model = m;
    }
    if (best == -1e300) return;
    depart(best_model, 2, 3);
    s.layered = check(solve(solver_, best_model), 3);
  }

  GroundShape shape_of(const GroundSummary& s) const {
    if (s.line.holds()) return solver_.broken_cells() > 0 ? GroundShape::crusted : GroundShape::line;
    if (s.power_law.holds() && solver_.broken_cells() == 0) return GroundShape::power_law;
    if (s.layered.holds()) return GroundShape::layered;
    return GroundShape::other;
  }

  const ProfileSolver& solver_;
  JointConfig joint_;
  double believed_;
  double from_m_, to_m_;
};

}  // namespace

GroundSummary summarise(const ProfileSolver& solver) noexcept {
  GroundSummary summary = Summariser(solver).run();
  const auto reloading = solver.reloading().line();
  summary.reloading_N_per_m = {reloading.value_N_per_m, reloading.ci95_low_N_per_m,
                               reloading.ci95_high_N_per_m};
  return summary;
}

}  // namespace sandhopper
