#include "tools/diagnose/discrepancy/model_error.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"
#include "tools/diagnose/fit/signatures.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

// Largest number of knots in time.
constexpr Index kMostForceKnots = 40;

// Cholesky factor L, L L' = `knot_correlation`.
MatrixXd process_factor(Index count) { return knot_correlation(count).llt().matrixL(); }

// Derivatives by a force at `port` that is a hat function of time around each knot, times the Cholesky factor
// of the process.
MatrixXd port_columns(const Problem& problem, const TrialModel& trial, const Edits& base,
                      const std::vector<double>& nuisances, const VectorXd& centre, const FreePort& port,
                      double knot_s) {
  double first = 1e300, last = -1e300;
  for (const auto& row : trial.rows) first = std::min(first, row.time_s), last = std::max(last, row.time_s);
  const Index count = std::clamp<Index>(static_cast<Index>((last - first) / knot_s) + 1, 2, kMostForceKnots);
  const double apart = (last - first) / static_cast<double>(count - 1);
  MatrixXd columns(centre.size(), count);
  for (Index k = 0; k < count; ++k) {
    const double knot = first + apart * static_cast<double>(k), scale = port.scale;
    const FreeTerm term{port.port, port.sensor,
                        [=](const PortState& s) {
                          const double u = 1.0 - std::abs(time_of(s) - knot) / apart;
                          return u > 0.0 ? scale * u : 0.0;
                        },
                        scale};
    columns.col(k) =
        (predicted(problem, trial, with_term(base, term, kTermStep), nuisances) - centre) / kTermStep;
  }
  return columns * process_factor(count);
}

ModelError at(const Problem& problem, const TrialModel& trial, const Edits& base,
              const std::vector<double>& nuisances) {
  const ModelErrorScales& s = kModelErrorScales;
  const VectorXd centre = predicted(problem, trial, base, nuisances);
  const Edits edits = trial.with_key_spreads(base, nuisances);
  std::vector<MatrixXd> parts;
  VectorXd rest = VectorXd::Zero(centre.size());
  VectorXd one(centre.size()), other(centre.size());
  const auto predict = [&](const Variant& variant, VectorXd& out) {
    trial.predict_variant(variant, edits, nuisances, {out.data(), static_cast<std::size_t>(out.size())});
    __atomic_fetch_add(&problem.simulations, 1, __ATOMIC_RELAXED);
  };
  for (const auto& [sooner, later] : trial.variants()) {
    predict(later, other);
    if (sooner.empty()) {
      parts.emplace_back(s.numerical * (other - centre));
    } else {
      predict(sooner, one);
      // Half of the difference is a column. The mean deviation has no sign and goes to the standard deviation
      // of the row.
      parts.emplace_back(s.numerical * 0.5 * (other - one));
      rest.array() += (s.numerical * 0.5 * (other + one - 2.0 * centre)).array().square();
    }
  }
  if (const double size = problem.port_error; size > 0.0)
    for (const auto& port : problem.plant->free_ports(problem.context))
      if (!port.sensor)
        parts.emplace_back(size * port_columns(problem, trial, base, nuisances, centre, port, s.port_knot_s));
  Index count = 0;
  for (const auto& part : parts) count += part.cols();
  ModelError error;
  error.columns.resize(centre.size(), count);
  count = 0;
  for (const auto& part : parts) {
    error.columns.middleCols(count, part.cols()) = part;
    count += part.cols();
  }
  if (!error.columns.allFinite()) error.columns.setZero();
  error.row_sd = rest.array().sqrt();
  if (!error.row_sd.allFinite()) error.row_sd.setZero();
  return error;
}

// A column may act in several blocks: split it into one independent column per block, if it acts there.
void split_by_block(const TrialModel& trial, ModelError& error) {
  if (trial.blocks < 2) return;
  const Index rows = error.columns.rows(), count = error.columns.cols();
  MatrixXd squares = MatrixXd::Zero(static_cast<Index>(trial.blocks), count);
  const auto block = [&](Index k) {
    return static_cast<Index>(trial.rows[static_cast<std::size_t>(k)].block);
  };
  for (Index k = 0; k < rows; ++k) squares.row(block(k)) += error.columns.row(k).cwiseAbs2();
  const double least = 1e-6;  // relative to the block's largest column
  std::vector<std::pair<Index, Index>> kept;
  for (Index b = 0; b < squares.rows(); ++b)
    for (Index c = 0; c < count; ++c)
      if (squares(b, c) > least * squares.row(b).maxCoeff()) kept.emplace_back(b, c);
  MatrixXd out = MatrixXd::Zero(rows, static_cast<Index>(kept.size()));
  for (Index i = 0; i < out.cols(); ++i) {
    const auto [b, c] = kept[static_cast<std::size_t>(i)];
    for (Index k = 0; k < rows; ++k)
      if (block(k) == b) out(k, i) = error.columns(k, c);
  }
  error.columns = std::move(out);
}

}  // namespace

RepeatableError repeatable_error(const Problem& problem, const Signatures& signatures) {
  const ModelErrorScales& s = kModelErrorScales;
  RepeatableError out;
  std::vector<Index> taken;
  std::vector<double> weights;
  int groups = 0;
  const auto take = [&](Index column, std::size_t candidate, double sd) {
    taken.push_back(column);
    weights.push_back(sd);
    out.group.push_back(groups);
    out.candidate.push_back(candidate);
  };
  std::vector<std::pair<Index, Index>> families;  // first column, number of columns
  for (const auto& [family, first] : signatures.laws) {
    if (family.sensor || !family.of_model_error) continue;
    const auto count = static_cast<Index>(family.terms.size());
    families.emplace_back(static_cast<Index>(taken.size()), count);
    for (Index i = 0; i < count; ++i) take(first + i, RepeatableError::kNoCandidate, s.repeatable);
    ++groups;
  }
  for (const auto& alternative : signatures.alternatives) {
    if (!out.candidate.empty() && out.candidate.back() == alternative.candidate) continue;
    const Port port = problem.candidates[alternative.candidate].effect->port;
    for (std::size_t i = 0; i < alternative.amplitudes.size(); ++i)
      take(alternative.first + static_cast<Index>(i), alternative.candidate,
           port == Port::sensor || port == Port::clock ? s.reading : s.typical);
  }
  out.white.resize(problem.trials.size());
  parallel_for(problem.trials.size(), [&](std::size_t t) {
    MatrixXd& columns = out.white[t];
    columns = signatures.columns[t](Eigen::all, taken);
    for (std::size_t i = 0; i < weights.size(); ++i) columns.col(static_cast<Index>(i)) *= weights[i];
    for (const auto& [first, count] : families) columns.middleCols(first, count) *= process_factor(count);
    whiten(problem, t, columns);
  });
  return out;
}

std::vector<ModelError> model_errors(const Problem& problem, const Point& point) {
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<ModelError> errors(problem.trials.size());
  parallel_for(errors.size(), [&](std::size_t t) {
    errors[t] = at(problem, *problem.trials[t], base, point.nuisances[t]);
    split_by_block(*problem.trials[t], errors[t]);
  });
  return errors;
}

void take_model_error(Problem& problem, std::vector<ModelError> errors) {
  problem.model_error = std::move(errors);
  for (std::size_t t = 0; t < problem.model_error.size(); ++t)
    for (std::size_t k = 0; k < problem.trials[t]->rows.size(); ++k)
      problem.trials[t]->rows[k].numerical_sd = problem.model_error[t].row_sd[static_cast<Index>(k)];
  take_noise(problem, NoiseModel(problem.noise));
}

void take_noise(Problem& problem, NoiseModel noise) {
  problem.noise = std::move(noise);
  problem.repeatable_error = {};
  parallel_for(problem.model_error.size(), [&](std::size_t t) {
    ModelError& error = problem.model_error[t];
    error.white = error.columns;
    problem.noise.whiten(*problem.trials[t], problem.used[t], error.white);
    error.low_rank = LowRank(error.white);
  });
}

double row_sd(const Problem& problem, std::size_t t, std::size_t k) {
  const TrialModel& trial = *problem.trials[t];
  const double noise = problem.noise.sd(trial, trial.rows[k]);
  if (t >= problem.model_error.size()) return noise;
  return std::hypot(noise, problem.model_error[t].columns.row(static_cast<Index>(k)).norm());
}

void whiten(const Problem& problem, std::size_t t, Eigen::Ref<MatrixXd> values) {
  problem.noise.whiten(*problem.trials[t], problem.used[t], values);
  if (t < problem.model_error.size()) problem.model_error[t].low_rank.whiten(values);
}

}  // namespace sandhopper::diagnose
