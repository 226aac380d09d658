#include "tools/diagnose/residuals.hpp"

#include <Eigen/Cholesky>

#include "tools/diagnose/screen.hpp"

namespace sandhopper::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kProbe = 0.2;  // of a free law's scale

struct Columns {
  std::vector<Direction> directions;
  VectorXd prior;  // information
};

Columns columns_of(const Problem& problem, const Point& point, const FreeFamily* rest) {
  Columns columns{parameter_directions(problem, point), {}};
  const auto own = static_cast<Index>(columns.directions.size());
  if (rest != nullptr) {
    const Edits base = edits_for(problem, point.hypothesis, point.tolerances);
    for (const auto& term : rest->terms)
      columns.directions.push_back({with_term(base, term, kProbe), kProbe});
  }
  columns.prior = VectorXd::Constant(static_cast<Index>(columns.directions.size()), kFreeLawInformation);
  columns.prior.head(own) = prior_information(problem, point);
  return columns;
}

// What each effect does to the rows of a trial: its amplitudes times their derivatives.
std::vector<VectorXd> changes(const Problem& problem, const Point& point, const MatrixXd& plain) {
  std::vector<VectorXd> out;
  Index column = 1;
  for (std::size_t e = 0; e < point.hypothesis.candidates.size(); ++e) {
    const auto& parameters = problem.candidates[point.hypothesis.candidates[e]].parameters;
    VectorXd sum = VectorXd::Zero(plain.rows());
    for (std::size_t j = 0; j < parameters.size(); ++j, ++column)
      if (is_amplitude(parameters, j))
        sum += plain.col(column) * (point.hypothesis.values[e][j] / parameters[j].typical);
    out.push_back(std::move(sum));
  }
  return out;
}

}  // namespace

Residuals residuals_of(const Problem& problem, const Search& search, const FreeFamily* rest) {
  Residuals out;
  for (auto& trial : linearise_all(problem, search.null().fit.point, {}, {.keep_plain = true}))
    out.before.emplace_back(trial.plain.col(0));

  const Point& point = search.best().fit.point;
  const auto columns = columns_of(problem, point, rest);
  const auto k = static_cast<Index>(columns.directions.size());
  const auto linear = linearise_all(problem, point, columns.directions, {.keep_plain = true});
  MatrixXd information = columns.prior.asDiagonal();
  VectorXd score = VectorXd::Zero(k);
  for (const auto& trial : linear) {
    information += trial.gram.bottomRightCorner(k, k);
    score += trial.gram.col(0).tail(k);
  }
  const VectorXd all = k > 0 ? VectorXd(information.ldlt().solve(score)) : VectorXd();
  for (const auto& trial : linear) {
    VectorXd after = trial.plain.col(0), held_out = after;
    if (k > 0 && rest != nullptr) after -= trial.plain.rightCols(k) * all;
    if (k > 0 && linear.size() > 1) {
      const MatrixXd others = information - trial.gram.bottomRightCorner(k, k);
      held_out -= trial.plain.rightCols(k) * others.ldlt().solve(score - trial.gram.col(0).tail(k));
    }
    out.after.push_back(std::move(after));
    out.held_out.push_back(std::move(held_out));
    out.change.push_back(changes(problem, point, trial.plain));
  }
  return out;
}

}  // namespace sandhopper::diagnose
