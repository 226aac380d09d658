#include "tools/diagnose/fit/linearise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "tools/experiment/parallel.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kToleranceStep = 0.1;  // in scales of the tolerance
constexpr double kNuisanceStep = 0.5;   // greatest step, in standard deviations of the nuisance

// Step of the derivative, limited to the plausible range of the nuisance.
double step_of(const Nuisance& nuisance) { return std::min(nuisance.step, kNuisanceStep * nuisance.sd); }

struct Centre {
  std::size_t index;
  const Edits& edits;
  const std::vector<double>& nuisances;
  const VectorXd& prediction;
};

void whiten(const Problem& problem, std::size_t index, KeptColumns& kept) {
  const TrialModel& trial = *problem.trials[index];
  kept.white_shared = kept.shared;
  kept.white_block = kept.block;
  whiten(problem, index, kept.white_shared);
  whiten(problem, index, kept.white_block);
  kept.gram = kept.white_shared.transpose() * kept.white_shared;
  if (!trial.block_nuisances.empty()) {
    const auto nb = static_cast<Index>(trial.block_nuisances.size());
    kept.block_gram.assign(trial.blocks, MatrixXd::Zero(nb, nb));
    kept.block_by_shared.assign(trial.blocks, MatrixXd::Zero(nb, kept.shared.cols()));
    for (std::size_t k = 0; k < trial.rows.size(); ++k) {
      const auto b = trial.rows[k].block;
      const auto row = static_cast<Index>(k);
      kept.block_gram[b].noalias() += kept.white_block.row(row).transpose() * kept.white_block.row(row);
      kept.block_by_shared[b].noalias() += kept.white_block.row(row).transpose() * kept.white_shared.row(row);
    }
  }
}

KeptColumns columns_at(const Problem& problem, const Centre& at) {
  const TrialModel& trial = *problem.trials[at.index];
  const auto rows = static_cast<Index>(trial.rows.size());
  const auto tolerances = static_cast<Index>(problem.tolerances.size());
  KeptColumns kept;
  kept.shared.resize(rows, tolerances + static_cast<Index>(trial.trial_nuisances.size()));
  kept.block.resize(rows, static_cast<Index>(trial.block_nuisances.size()));
  for (Index i = 0; i < tolerances; ++i) {
    Edits moved = at.edits;
    problem.tolerances[static_cast<std::size_t>(i)].put(moved, kToleranceStep);
    kept.shared.col(i) = (predicted(problem, trial, moved, at.nuisances) - at.prediction) / kToleranceStep;
  }
  auto moved = at.nuisances;
  const std::size_t q = trial.trial_nuisances.size(), width = trial.block_nuisances.size();
  for (std::size_t i = 0; i < q; ++i) {
    const double step = step_of(trial.trial_nuisances[i]);
    moved[i] = at.nuisances[i] + step;
    const VectorXd above = predicted(problem, trial, at.edits, moved);
    moved[i] = at.nuisances[i] - step;
    kept.shared.col(tolerances + static_cast<Index>(i)) =
        (above - predicted(problem, trial, at.edits, moved)) / (2.0 * step);
    moved[i] = at.nuisances[i];
  }
  for (std::size_t j = 0; j < width; ++j) {
    const double step = step_of(trial.block_nuisances[j]);
    for (std::uint32_t b = 0; b < trial.blocks; ++b) moved[q + b * width + j] += step;
    kept.block.col(static_cast<Index>(j)) =
        (predicted(problem, trial, at.edits, moved) - at.prediction) / step;
    for (std::uint32_t b = 0; b < trial.blocks; ++b)
      moved[q + b * width + j] = at.nuisances[q + b * width + j];
  }
  whiten(problem, at.index, kept);
  return kept;
}

// Inner products of whitened columns: those of `x`, then the kept ones in the order of `columns`.
MatrixXd gram_of(const MatrixXd& x, const std::vector<Index>& columns, const KeptColumns& kept) {
  const Index own = x.cols(), more = static_cast<Index>(columns.size());
  const MatrixXd cross = x.transpose() * kept.white_shared;
  MatrixXd gram(own + more, own + more);
  MatrixXd products = MatrixXd::Zero(own, own);
  products.selfadjointView<Eigen::Lower>().rankUpdate(x.transpose());
  gram.topLeftCorner(own, own) = products.selfadjointView<Eigen::Lower>();
  for (Index j = 0; j < more; ++j) {
    const Index c = columns[static_cast<std::size_t>(j)];
    gram.block(0, own + j, own, 1) = cross.col(c);
    gram.block(own + j, 0, 1, own) = cross.col(c).transpose();
    for (Index i = 0; i < more; ++i)
      gram(own + i, own + j) = kept.gram(columns[static_cast<std::size_t>(i)], c);
  }
  return gram;
}

// ln |M| of a factored positive definite matrix M, plus ln of the prior variances of its nuisances.
double log_determinant_of(const Eigen::LDLT<MatrixXd>& factored, const std::vector<Nuisance>& nuisances) {
  double sum = factored.vectorD().array().log().sum();
  for (const auto& nuisance : nuisances) sum += 2.0 * std::log(nuisance.sd);
  return sum;
}

// Eliminates the nuisances of each block from `gram` (Schur complement). Returns their solution for each
// block; adds their part to `log_determinant`.
std::vector<MatrixXd> eliminate_blocks(const TrialModel& trial, const std::vector<double>& zeta,
                                       const MatrixXd& x, const std::vector<Index>& columns,
                                       const KeptColumns& kept, double damping, MatrixXd& gram,
                                       double& log_determinant) {
  const Index nb = kept.block.cols(), own = x.cols();
  const auto q = static_cast<Index>(trial.trial_nuisances.size());
  std::vector<MatrixXd> solution;
  if (nb == 0) return solution;
  std::vector<MatrixXd> c(trial.blocks, MatrixXd::Zero(nb, own));
  for (std::size_t k = 0; k < trial.rows.size(); ++k) {
    const auto row = static_cast<Index>(k);
    c[trial.rows[k].block].noalias() += kept.white_block.row(row).transpose() * x.row(row);
  }
  for (std::size_t b = 0; b < trial.blocks; ++b) {
    MatrixXd hb = kept.block_gram[b];
    MatrixXd cb(nb, gram.cols());
    cb.leftCols(own) = c[b];
    for (Index j = 0; j < gram.cols() - own; ++j)
      cb.col(own + j) = kept.block_by_shared[b].col(columns[static_cast<std::size_t>(j)]);
    for (Index j = 0; j < nb; ++j) {
      const double weight = 1.0 / std::pow(trial.block_nuisances[static_cast<std::size_t>(j)].sd, 2);
      const double value = zeta[static_cast<std::size_t>(q + static_cast<Index>(b) * nb + j)];
      hb(j, j) = (1.0 + damping) * (hb(j, j) + weight);
      cb(j, 0) -= weight * value;
      gram(0, 0) += weight * value * value;
    }
    const Eigen::LDLT<MatrixXd> factored(hb);
    log_determinant += log_determinant_of(factored, trial.block_nuisances);
    solution.push_back(factored.solve(cb));
    gram.noalias() -= cb.transpose() * solution.back();
  }
  return solution;
}

// Eliminates the nuisances: blocks one by one, then those of the trial. `x` is whitened and begins with the
// residual; in the result the kept columns `wanted` (tolerances) follow it.
void eliminate(const TrialModel& trial, const std::vector<double>& zeta, const MatrixXd& x,
               const std::vector<Index>& wanted, const KeptColumns& kept, double damping, TrialLinear& out) {
  const auto q = static_cast<Index>(trial.trial_nuisances.size());
  const Index nb = kept.block.cols();
  const Index width = x.cols() + static_cast<Index>(wanted.size());
  const auto count = static_cast<Index>(trial.nuisance_count());
  // Kept columns that take part, in the order of the result: tolerances asked for, then nuisances.
  std::vector<Index> columns = wanted;
  for (Index i = 0; i < q; ++i) columns.push_back(kept.shared.cols() - q + i);
  MatrixXd gram = gram_of(x, columns, kept);
  for (Index i = 0; i < q; ++i) {
    const double weight = 1.0 / std::pow(trial.trial_nuisances[static_cast<std::size_t>(i)].sd, 2);
    const double value = zeta[static_cast<std::size_t>(i)];
    gram(width + i, width + i) = (1.0 + damping) * (gram(width + i, width + i) + weight);
    gram(width + i, 0) -= weight * value;
    gram(0, width + i) -= weight * value;
    gram(0, 0) += weight * value * value;
  }
  const auto block_solution =
      eliminate_blocks(trial, zeta, x, columns, kept, damping, gram, out.log_determinant);
  out.solution = MatrixXd::Zero(count, width);
  if (q > 0) {
    const Eigen::LDLT<MatrixXd> factored(gram.bottomRightCorner(q, q));
    out.log_determinant += log_determinant_of(factored, trial.trial_nuisances);
    const MatrixXd inner = factored.solve(gram.bottomLeftCorner(q, width));
    out.gram = gram.topLeftCorner(width, width) - gram.topRightCorner(width, q) * inner;
    out.solution.topRows(q) = inner;
  } else {
    out.gram = gram;
  }
  for (std::size_t b = 0; b < block_solution.size(); ++b) {
    const auto& s = block_solution[b];
    out.solution.middleRows(q + static_cast<Index>(b) * nb, nb) =
        s.leftCols(width) - s.rightCols(q) * out.solution.topRows(q);
  }
}

// Columns of `m` in another order.
MatrixXd in_order(const MatrixXd& m, const std::vector<Index>& order) {
  MatrixXd out(m.rows(), static_cast<Index>(order.size()));
  for (std::size_t i = 0; i < order.size(); ++i) out.col(static_cast<Index>(i)) = m.col(order[i]);
  return out;
}

}  // namespace

VectorXd predicted(const Problem& problem, const TrialModel& trial, const Edits& edits,
                   const std::vector<double>& nuisances) {
  VectorXd out(static_cast<Index>(trial.rows.size()));
  const std::span<double> rows(out.data(), static_cast<std::size_t>(out.size()));
  if (trial.has_key_spreads())
    trial.predict(trial.with_key_spreads(edits, nuisances), nuisances, rows);
  else
    trial.predict(edits, nuisances, rows);
  for (Index i = 0; i < out.size(); ++i)
    if (!std::isfinite(out[i])) out[i] = 1e6;
  __atomic_fetch_add(&problem.simulations, 1, __ATOMIC_RELAXED);
  return out;
}

VectorXd residual_of(const TrialModel& trial, const VectorXd& prediction) {
  VectorXd out(prediction.size());
  for (Index k = 0; k < out.size(); ++k)
    out[k] = trial.rows[static_cast<std::size_t>(k)].measured - prediction[k];
  return out;
}

namespace {

// The columns of `forms`. `derivatives`: one per direction; empty for a tolerance.
MatrixXd form_columns(const TrialModel& trial, const std::vector<FormOf>& forms,
                      const std::vector<VectorXd>& derivatives) {
  const auto rows = static_cast<Index>(trial.rows.size());
  double first_s = 1e300, last_s = -1e300;
  for (const auto& row : trial.rows) {
    first_s = std::min(first_s, row.time_s);
    last_s = std::max(last_s, row.time_s);
  }
  const double apart_s = (last_s - first_s) / static_cast<double>(kFormKnots - 1);
  MatrixXd out = MatrixXd::Zero(rows, kFormKnots * static_cast<Index>(forms.size()));
  for (std::size_t f = 0; f < forms.size(); ++f) {
    VectorXd signature = VectorXd::Zero(rows);
    for (const auto& [direction, weight] : forms[f].directions) signature += weight * derivatives[direction];
    for (Index k = 0; k < rows; ++k) {
      const double at =
          apart_s > 0.0 ? (trial.rows[static_cast<std::size_t>(k)].time_s - first_s) / apart_s : 0.0;
      const Index knot = std::clamp<Index>(static_cast<Index>(at), 0, kFormKnots - 2);
      const double share = at - static_cast<double>(knot);
      const Index column = static_cast<Index>(f) * kFormKnots + knot;
      out(k, column) = (1.0 - share) * signature[k];
      out(k, column + 1) = share * signature[k];
    }
  }
  return out;
}

// Columns of one trial, simulated ones first, then tolerances. `order` restores the order of the directions.
struct Gathered {
  MatrixXd x;                 // residual and simulated columns
  std::vector<Index> wanted;  // tolerances, as indices of kept columns
  std::vector<Index> order{0};

  // Appends columns. In the result they follow all directions, also the tolerances.
  void append(const MatrixXd& more) {
    const Index own = x.cols();
    x.conservativeResize(Eigen::NoChange, own + more.cols());
    x.rightCols(more.cols()) = more;
    for (auto& place : order)
      if (place >= own) place += more.cols();
    for (Index i = 0; i < more.cols(); ++i) order.push_back(own + i);
  }
};

// `derivative_by(direction)` is the derivative of one that is no tolerance.
template <class DerivativeBy>
Gathered gathered(const VectorXd& residual, const std::vector<Direction>& directions,
                  const DerivativeBy& derivative_by) {
  Gathered columns;
  std::vector<const Direction*> simulated;
  for (const auto& direction : directions)
    if (direction.tolerance < 0)
      simulated.push_back(&direction);
    else
      columns.wanted.push_back(direction.tolerance);
  Index next_simulated = 1, next_wanted = 1 + static_cast<Index>(simulated.size());
  for (const auto& direction : directions)
    columns.order.push_back(direction.tolerance < 0 ? next_simulated++ : next_wanted++);
  columns.x.resize(residual.size(), 1 + static_cast<Index>(simulated.size()));
  columns.x.col(0) = residual;
  for (std::size_t i = 0; i < simulated.size(); ++i)
    columns.x.col(static_cast<Index>(i) + 1) = derivative_by(*simulated[i]);
  return columns;
}

// Subtracts from each plain column the part that refitted nuisances take up.
void let_nuisances_follow(const TrialModel& trial, const KeptColumns& kept, TrialLinear& out) {
  const auto q = static_cast<Index>(trial.trial_nuisances.size());
  const Index nb = kept.block.cols();
  out.plain.noalias() -= kept.shared.rightCols(q) * out.solution.topRows(q);
  for (Index k = 0; k < out.plain.rows() && nb > 0; ++k)
    out.plain.row(k) -= kept.block.row(k) *
                        out.solution.middleRows(
                            q + static_cast<Index>(trial.rows[static_cast<std::size_t>(k)].block) * nb, nb);
}

}  // namespace

std::optional<VectorXd> derivative_of_alike(const Problem& problem, std::size_t trial,
                                            const Direction& direction, const KeptColumns& kept) {
  if (direction.like.empty()) return std::nullopt;
  const auto alike = problem.trials[trial]->like(direction.like);
  if (!alike) return std::nullopt;
  const auto column = static_cast<Index>(problem.tolerances.size() + alike->nuisance);
  return kept.shared.col(column) * (alike->per_unit * direction.like_step);
}

TrialLinear linearise(const Problem& problem, std::size_t index, const Edits& base,
                      const std::vector<double>& nuisances, const std::vector<Direction>& directions,
                      const LineariseOptions& options) {
  const TrialModel& trial = *problem.trials[index];
  const VectorXd centre =
      options.prediction != nullptr ? *options.prediction : predicted(problem, trial, base, nuisances);
  KeptColumns own_columns;
  const auto& known = options.columns != nullptr ? *options.columns : problem.kept_columns;
  const bool fresh = options.fresh_columns || known.empty();
  if (fresh) own_columns = columns_at(problem, {index, base, nuisances, centre});
  const KeptColumns& kept = fresh ? own_columns : known[index];

  TrialLinear out;
  out.residual = residual_of(trial, centre);
  Gathered columns = gathered(out.residual, directions, [&](const Direction& direction) {
    if (auto alike = derivative_of_alike(problem, index, direction, kept)) return *std::move(alike);
    return derivative(direction, centre,
                      [&](const Edits& edits) { return predicted(problem, trial, edits, nuisances); });
  });
  MatrixXd& x = columns.x;
  if (options.forms != nullptr) {
    std::vector<VectorXd> derivatives(directions.size());
    Index at = 1;
    for (std::size_t i = 0; i < directions.size(); ++i)
      if (directions[i].tolerance < 0) derivatives[i] = x.col(at++);
    columns.append(form_columns(trial, *options.forms, derivatives));
  }
  if (options.more != nullptr) columns.append((*options.more)[index]);
  if (options.keep_plain) {
    out.plain.resize(x.rows(), x.cols() + static_cast<Index>(columns.wanted.size()));
    out.plain.leftCols(x.cols()) = x;
    for (std::size_t i = 0; i < columns.wanted.size(); ++i)
      out.plain.col(x.cols() + static_cast<Index>(i)) = kept.shared.col(columns.wanted[i]);
  }
  whiten(problem, index, x);
  if (options.with_repeatable_error && index < problem.repeatable_error.white.size())
    columns.append(problem.repeatable_error.white[index]);
  eliminate(trial, nuisances, x, columns.wanted, kept, options.damping, out);
  if (options.keep_plain) {
    let_nuisances_follow(trial, kept, out);
    out.plain = in_order(out.plain, columns.order);
  }
  out.solution = in_order(out.solution, columns.order);
  out.gram = in_order(MatrixXd(in_order(out.gram, columns.order).transpose()), columns.order);
  return out;
}

std::vector<TrialLinear> linearise_all(const Problem& problem, const Point& point,
                                       const std::vector<Direction>& directions,
                                       const LineariseOptions& options) {
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<TrialLinear> out((problem.trials.size() + options.every - 1) / options.every);
  parallel_for(out.size(), [&](std::size_t i) {
    const std::size_t t = i * options.every;
    out[i] = linearise(problem, t, base, point.nuisances[t], directions, options);
  });
  return out;
}

KeptColumns columns_of(const Problem& problem, std::size_t trial, const Edits& base,
                       const std::vector<double>& nuisances) {
  const auto centre = predicted(problem, *problem.trials[trial], base, nuisances);
  return columns_at(problem, {trial, base, nuisances, centre});
}

std::vector<KeptColumns> columns_at(const Problem& problem, const Point& point) {
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<KeptColumns> columns(problem.trials.size());
  parallel_for(columns.size(),
               [&](std::size_t t) { columns[t] = columns_of(problem, t, base, point.nuisances[t]); });
  return columns;
}

void keep_columns(Problem& problem, const Point& point) { problem.kept_columns = columns_at(problem, point); }

}  // namespace sandhopper::diagnose
