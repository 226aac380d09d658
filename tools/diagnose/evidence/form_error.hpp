#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"

// Error in the form of the laws of named effects: the true law of an effect has a somewhat different form, or
// its size differs between trials. In trial t the effect's signature is multiplied by 1 + g_t(time), with
//   g_t ~ N(0, C),   C_ij = Limits::form^2 R_ij + Limits::size_of_trial^2
// at the kFormKnots knots of a trial, R = `knot_correlation`, independent between trials. The columns are
// those that `linearise_all` makes for `LineariseOptions::forms`.
namespace sandhopper::diagnose {

// Signatures of the effects of a hypothesis at its values, in the order of its candidates.
std::vector<FormOf> forms_of(const Problem& problem, const Hypothesis& hypothesis);

// The same without effects on readings and time stamps: a bias, a scale or a delay is a number, and an
// encoder off its centre is geometry; only a law can have another form.
std::vector<FormOf> laws_of(const Problem& problem, const Hypothesis& hypothesis);

// Inverse of C for so many effects, with both standard deviations times `share`.
Eigen::MatrixXd form_information(Eigen::Index effects, double share = 1.0);

// Gram matrix of one trial without the form errors of some effects: they are integrated out with their prior.
struct WithoutForms {
  Eigen::MatrixXd gram;
  double log_determinant = 0.0;  // ln|I + C F|, F: information of the trial on the forms
};
// `kept`, `forms`: columns of `gram`. `information`: of the forms' prior.
WithoutForms without_forms(const Eigen::MatrixXd& gram, const std::vector<Eigen::Index>& kept,
                           const std::vector<Eigen::Index>& forms, const Eigen::MatrixXd& information);

}  // namespace sandhopper::diagnose
