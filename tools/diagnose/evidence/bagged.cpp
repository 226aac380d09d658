#include "tools/diagnose/evidence/bagged.hpp"

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kDraws = 200;  // of the weights: standard error of a mass at most 0.035

// One column for each draw. Exponential values divided by their mean are n Dirichlet(1, ..., 1).
MatrixXd drawn_weights(Index trials) {
  MatrixXd weights(trials, kDraws);
  Random random(1, 0);
  for (double& weight : weights.reshaped()) weight = -std::log1p(-random.uniform());
  for (auto draw : weights.colwise()) draw /= draw.mean();
  return weights;
}

}  // namespace

std::vector<double> bagged_masses(const Problem& problem, const std::vector<const SetFit*>& fits) {
  const MatrixXd weights = drawn_weights(static_cast<Index>(problem.trials.size()));
  MatrixXd log_mass(fits.size(), kDraws);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const auto& fit = fits[i]->fit;
    const auto evidence = weighted_log_evidence(problem, fit, linearised_at(problem, fit.point), weights);
    const double prior = log_prior(problem, fits[i]->set);
    for (Index draw = 0; draw < kDraws; ++draw) {
      const double one = evidence[static_cast<std::size_t>(draw)] + prior;
      log_mass(static_cast<Index>(i), draw) =
          std::isfinite(one) ? one : std::numeric_limits<double>::lowest();
    }
  }
  VectorXd mass = VectorXd::Zero(log_mass.rows());
  for (const auto draw : log_mass.colwise()) {
    const VectorXd relative = (draw.array() - draw.maxCoeff()).exp();
    mass += relative / relative.sum() / static_cast<double>(kDraws);
  }
  return {mass.begin(), mass.end()};
}

}  // namespace sandhopper::diagnose
