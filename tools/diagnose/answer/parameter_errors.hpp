#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Errors of the parameters of a fit, in typical sizes. The estimate solves sum_t s_t(b) = (H - I) b, with the
// score s_t and the information I_t of trial t, I = sum_t I_t, and H = I + prior information. The error of a
// combination c'b, with l = H^-1 c:
//   variance = (r + v) l' I l + l' (H - I) l
// r: scatter of l' s_t between the trials, pooled with the noise (TrialScatter); v: `form_deviance`, of laws
// that have another form; the prior counts like an observation.
class ParameterErrors {
 public:
  ParameterErrors(const Problem& problem, const Point& point, double form_deviance);

  // Half of the 95 % interval of parameter `at`.
  double half_width(Eigen::Index at) const;
  // The same of the combination `along` of the parameters from `first` on.
  double half_width(Eigen::Index first, const Eigen::VectorXd& along) const;

 private:
  std::vector<Eigen::MatrixXd> of_trial_;  // I_t
  Eigen::MatrixXd scores_;                 // parameters x trials
  Eigen::MatrixXd information_, prior_, inverse_;
  double form_deviance_;
};

}  // namespace sandhopper::diagnose
