#include "tools/diagnose/answer/parameter_errors.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/levels.hpp"
#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

ParameterErrors::ParameterErrors(const Problem& problem, const Point& point, double form_deviance)
    : form_deviance_(form_deviance) {
  const auto directions = parameter_directions(problem, point);
  const auto linear = linearise_all(problem, point, directions);
  const auto k = static_cast<Index>(directions.size()),
             own = static_cast<Index>(point.hypothesis.parameters());
  information_ = MatrixXd::Zero(k, k);
  scores_.resize(k, static_cast<Index>(linear.size()));
  for (std::size_t t = 0; t < linear.size(); ++t) {
    of_trial_.push_back(linear[t].gram.bottomRightCorner(k, k));
    information_ += of_trial_.back();
    scores_.col(static_cast<Index>(t)) = linear[t].gram.col(0).tail(k);
  }
  // A tolerance that is held at its limit keeps a score in every trial, which is no scatter between them.
  for (std::size_t i = 0; i < point.tolerances.size(); ++i)
    if (std::abs(point.tolerances[i]) >= kMostTolerance) scores_.row(own + static_cast<Index>(i)).setZero();
  prior_ = MatrixXd::Identity(k, k);
  Index at = 0;
  for (const auto c : point.hypothesis.candidates)
    for (std::size_t j = 0; j < problem.candidates[c].parameters.size(); ++j, ++at)
      if (is_amplitude(problem.candidates[c].parameters, j)) prior_(at, at) = kPriorOfAmplitude;
  inverse_ = (information_ + prior_).ldlt().solve(MatrixXd::Identity(k, k));
}

double ParameterErrors::half_width(Index at) const { return half_width(at, VectorXd::Ones(1)); }

double ParameterErrors::half_width(Index first, const VectorXd& along) const {
  const VectorXd l = inverse_.middleCols(first, along.size()) * along;
  const auto trials = static_cast<Index>(of_trial_.size());
  MatrixXd of_trial(l.size(), trials);  // I_t l
  for (Index t = 0; t < trials; ++t) of_trial.col(t) = of_trial_[static_cast<std::size_t>(t)] * l;
  const VectorXd variances = of_trial.transpose() * l, left = scores_.transpose() * l;
  // The scores after the fit are u_t - I_t H^-1 sum_s u_s, where u_t has the covariance I_t.
  MatrixXd covariance =
      -of_trial.transpose() * (2.0 * inverse_ - inverse_ * information_ * inverse_) * of_trial;
  covariance.diagonal() += variances;
  const auto as_span = [](const VectorXd& v) {
    return std::span(v.data(), static_cast<std::size_t>(v.size()));
  };
  const auto scatter = with_noise(scatter_between(as_span(left), as_span(variances), covariance));
  const double variance = (scatter.ratio + form_deviance_) * variances.sum() + l.dot(prior_ * l);
  return student_t_quantile(kLevel, scatter.degrees_of_freedom) * std::sqrt(std::max(0.0, variance));
}

}  // namespace sandhopper::diagnose
