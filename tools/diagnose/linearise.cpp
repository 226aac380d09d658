#include "tools/diagnose/linearise.hpp"

#include <Eigen/Cholesky>

#include "tools/diagnose/parallel.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd predicted(const Problem& problem, const TrialModel& trial, const Edits& edits,
                   const std::vector<double>& nuisances) {
  VectorXd out(static_cast<Index>(trial.rows.size()));
  trial.predict(edits, nuisances, {out.data(), static_cast<std::size_t>(out.size())});
  for (Index i = 0; i < out.size(); ++i)
    if (!std::isfinite(out[i])) out[i] = 1e6;
  __atomic_fetch_add(&problem.simulations, 1, __ATOMIC_RELAXED);
  return out;
}

// Nuisance derivatives: whole-trial ones as columns, block ones packed (each row belongs to one block).
using NuisanceColumns = Problem::NuisanceColumns;

NuisanceColumns nuisance_columns(const Problem& problem, const TrialModel& trial, const Edits& edits,
                                 const std::vector<double>& nuisances, const VectorXd& centre) {
  const auto rows = static_cast<Index>(trial.rows.size());
  NuisanceColumns columns{MatrixXd(rows, static_cast<Index>(trial.trial_nuisances.size())),
                          MatrixXd(rows, static_cast<Index>(trial.block_nuisances.size()))};
  auto moved = nuisances;
  for (std::size_t i = 0; i < trial.trial_nuisances.size(); ++i) {
    const double step = trial.trial_nuisances[i].step;
    moved[i] += step;
    columns.trial.col(static_cast<Index>(i)) = (predicted(problem, trial, edits, moved) - centre) / step;
    moved[i] = nuisances[i];
  }
  const std::size_t first = trial.trial_nuisances.size(), width = trial.block_nuisances.size();
  for (std::size_t j = 0; j < width; ++j) {
    const double step = trial.block_nuisances[j].step;
    for (std::uint32_t b = 0; b < trial.blocks; ++b) moved[first + b * width + j] += step;
    columns.block.col(static_cast<Index>(j)) = (predicted(problem, trial, edits, moved) - centre) / step;
    for (std::uint32_t b = 0; b < trial.blocks; ++b) {
      const auto at = first + b * width + j;
      moved[at] = nuisances[at];
    }
  }
  return columns;
}

// Eliminates nuisances: blocks one by one, then those of the trial. `x` is whitened, residual first.
void eliminate(const TrialModel& trial, const std::vector<double>& zeta, const MatrixXd& x,
               const NuisanceColumns& z, TrialLinear& out) {
  const Index width = x.cols(), q = z.trial.cols(), nb = z.block.cols();
  const auto count = static_cast<Index>(trial.nuisance_count());
  // [X, Z_trial] together are what the blocks' elimination acts on.
  MatrixXd all(x.rows(), width + q);
  all << x, z.trial;
  MatrixXd gram = all.transpose() * all;
  for (Index i = 0; i < q; ++i) {
    const double weight = 1.0 / std::pow(trial.trial_nuisances[static_cast<std::size_t>(i)].sd, 2);
    const double value = zeta[static_cast<std::size_t>(i)];
    gram(width + i, width + i) += weight;
    gram(width + i, 0) -= weight * value;
    gram(0, width + i) -= weight * value;
    gram(0, 0) += weight * value * value;
  }
  std::vector<MatrixXd> block_solution;
  if (nb > 0) {
    const auto blocks = static_cast<Index>(trial.blocks);
    std::vector<MatrixXd> h(trial.blocks, MatrixXd::Zero(nb, nb)),
        c(trial.blocks, MatrixXd::Zero(nb, width + q));
    for (std::size_t k = 0; k < trial.rows.size(); ++k) {
      const auto b = trial.rows[k].block;
      const auto row = static_cast<Index>(k);
      h[b].noalias() += z.block.row(row).transpose() * z.block.row(row);
      c[b].noalias() += z.block.row(row).transpose() * all.row(row);
    }
    for (Index b = 0; b < blocks; ++b) {
      auto& hb = h[static_cast<std::size_t>(b)];
      auto& cb = c[static_cast<std::size_t>(b)];
      for (Index j = 0; j < nb; ++j) {
        const double weight = 1.0 / std::pow(trial.block_nuisances[static_cast<std::size_t>(j)].sd, 2);
        const double value = zeta[static_cast<std::size_t>(q + b * nb + j)];
        hb(j, j) += weight;
        cb(j, 0) -= weight * value;
        gram(0, 0) += weight * value * value;
      }
      block_solution.push_back(hb.ldlt().solve(cb));
      gram.noalias() -= cb.transpose() * block_solution.back();
    }
  }
  out.solution = MatrixXd::Zero(count, width);
  if (q > 0) {
    const MatrixXd inner = gram.bottomRightCorner(q, q).ldlt().solve(gram.bottomLeftCorner(q, width));
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

}  // namespace

TrialLinear linearise(const Problem& problem, std::size_t index, const Edits& base,
                      const std::vector<double>& nuisances, const std::vector<Direction>& directions,
                      const LineariseOptions& options) {
  const TrialModel& trial = *problem.trials[index];
  const auto& used = problem.used[index];
  const auto rows = static_cast<Index>(trial.rows.size());
  const VectorXd centre = predicted(problem, trial, base, nuisances);
  TrialLinear out;
  out.residual.resize(rows);
  for (Index k = 0; k < rows; ++k)
    out.residual[k] = trial.rows[static_cast<std::size_t>(k)].measured - centre[k];

  MatrixXd x(rows, 1 + static_cast<Index>(directions.size()));
  x.col(0) = out.residual;
  for (std::size_t i = 0; i < directions.size(); ++i)
    x.col(static_cast<Index>(i) + 1) =
        (predicted(problem, trial, directions[i].edits, nuisances) - centre) / directions[i].step;
  NuisanceColumns z = options.fresh_nuisances || problem.nuisance_columns.empty()
                          ? nuisance_columns(problem, trial, base, nuisances, centre)
                          : problem.nuisance_columns[index];
  MatrixXd plain_x, plain_z, plain_b;
  if (options.keep_plain) {
    plain_x = x;
    plain_z = z.trial;
    plain_b = z.block;
  }
  for (Index i = 0; i < x.cols(); ++i) problem.noise.whiten(trial, used, x.col(i));
  for (Index i = 0; i < z.trial.cols(); ++i) problem.noise.whiten(trial, used, z.trial.col(i));
  for (Index i = 0; i < z.block.cols(); ++i) problem.noise.whiten(trial, used, z.block.col(i));
  eliminate(trial, nuisances, x, z, out);
  if (options.keep_whitened) out.whitened = x;
  if (options.keep_plain) {
    // With the nuisances free to follow: column minus what they take up.
    const Index q = plain_z.cols(), nb = plain_b.cols();
    out.plain = plain_x - plain_z * out.solution.topRows(q);
    for (Index k = 0; k < rows && nb > 0; ++k)
      out.plain.row(k) -= plain_b.row(k) *
                          out.solution.middleRows(
                              q + static_cast<Index>(trial.rows[static_cast<std::size_t>(k)].block) * nb, nb);
  }
  return out;
}

std::vector<TrialLinear> linearise_all(const Problem& problem, const Point& point,
                                       const std::vector<Direction>& directions,
                                       const LineariseOptions& options) {
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<TrialLinear> out(problem.trials.size());
  in_parallel(out.size(), [&](std::size_t t) {
    out[t] = linearise(problem, t, base, point.nuisances[t], directions, options);
  });
  return out;
}

void keep_nuisance_columns(Problem& problem, const Point& point) {
  const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
  std::vector<NuisanceColumns> columns(problem.trials.size());
  in_parallel(columns.size(), [&](std::size_t t) {
    const auto centre = predicted(problem, *problem.trials[t], base, point.nuisances[t]);
    columns[t] = nuisance_columns(problem, *problem.trials[t], base, point.nuisances[t], centre);
  });
  problem.nuisance_columns = std::move(columns);
}

}  // namespace sandhopper::diagnose
