#include "tools/diagnose/evidence/simple_answers.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/linearise.hpp"

namespace sandhopper::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

SimpleAnswers simple_answers(const Problem& problem, const Point& null) {
  SimpleAnswers answers;
  std::vector<Direction> directions;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    const auto& parameters = problem.candidates[c].parameters;
    std::vector<double> values;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      values.push_back(i > 0 && is_amplitude(parameters, i) ? 0.0 : parameters[i].typical);
    const double step = std::min(problem.candidates[c].probe(), parameters[0].high / parameters[0].typical);
    values[0] *= step;
    Hypothesis one{{c}, {values}};
    directions.push_back({edits_for(problem, one, null.tolerances), step});
  }
  if (directions.empty() || problem.trials.empty()) return answers;
  const auto linear = linearise_all(problem, null, directions);
  const auto k = static_cast<Index>(directions.size());
  MatrixXd gram = MatrixXd::Zero(k + 1, k + 1);
  for (const auto& trial : linear) gram += trial.gram;
  const double whole = std::max(gram(0, 0), 1e-300);
  const VectorXd score = gram.col(0).tail(k);
  MatrixXd information = gram.bottomRightCorner(k, k);
  // The prior only matters for combinations that the data do not determine.
  information.diagonal().array() += kPriorOfAmplitude;
  const VectorXd all = information.ldlt().solve(score);
  for (Index i = 0; i < k; ++i) {
    const auto& id = problem.candidates[static_cast<std::size_t>(i)].effect->id;
    const double own = std::max(gram(i + 1, i + 1), 1e-300);
    const double correlation = std::abs(score[i]) / std::sqrt(own * whole);
    if (correlation > answers.correlation) {
      answers.correlation = correlation;
      answers.largest_correlation = id;
    }
    if (std::abs(all[i]) > answers.typicals) {
      answers.typicals = std::abs(all[i]);
      answers.fit_every_parameter = id;
    }
  }
  return answers;
}

}  // namespace sandhopper::diagnose
