#include "tools/diagnose/evidence/form_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/limits.hpp"
#include "tools/diagnose/evidence/log_determinant.hpp"

namespace sandhopper::diagnose {

using Eigen::Index, Eigen::MatrixXd;

std::vector<FormOf> forms_of(const Problem& problem, const Hypothesis& hypothesis) {
  std::vector<FormOf> forms;
  std::size_t at = 0;
  for (std::size_t e = 0; e < hypothesis.candidates.size(); ++e) {
    const auto& parameters = problem.candidates[hypothesis.candidates[e]].parameters;
    FormOf form;
    for (std::size_t j = 0; j < parameters.size(); ++j, ++at)
      if (is_amplitude(parameters, j))
        form.directions.emplace_back(at, hypothesis.values[e][j] / parameters[j].typical);
    forms.push_back(std::move(form));
  }
  return forms;
}

std::vector<FormOf> laws_of(const Problem& problem, const Hypothesis& hypothesis) {
  std::vector<FormOf> laws;
  const auto forms = forms_of(problem, hypothesis);
  for (std::size_t e = 0; e < forms.size(); ++e) {
    const Port port = problem.candidates[hypothesis.candidates[e]].effect->port;
    if (port != Port::sensor && port != Port::clock) laws.push_back(forms[e]);
  }
  return laws;
}

MatrixXd form_information(Index effects, double share) {
  const MatrixXd covariance = (kLimits.form * kLimits.form * knot_correlation(kFormKnots)).array() +
                              kLimits.size_of_trial * kLimits.size_of_trial;
  const MatrixXd of_one = (share * share * covariance).inverse();
  MatrixXd out = MatrixXd::Zero(effects * kFormKnots, effects * kFormKnots);
  for (Index f = 0; f < effects; ++f)
    out.block(f * kFormKnots, f * kFormKnots, kFormKnots, kFormKnots) = of_one;
  return out;
}

WithoutForms without_forms(const MatrixXd& gram, const std::vector<Index>& kept,
                           const std::vector<Index>& forms, const MatrixXd& information) {
  if (forms.empty()) return {gram(kept, kept), 0.0};
  const MatrixXd held = gram(forms, forms) + information;
  const MatrixXd cross = gram(kept, forms);
  return {gram(kept, kept) - cross * held.ldlt().solve(cross.transpose()),
          log_determinant(held) - log_determinant(information)};
}

}  // namespace sandhopper::diagnose
