#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"
#include "tools/diagnose/fit/signatures.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {

// Eliminates the columns [first, first + count) of all trials together, each with its prior information.
// These columns are what a point already fits (parameters, tolerances). Column 0 is the residual.
//   A'_t = T' A_t T,  T subtracts from each column its pooled regression on the eliminated ones
std::vector<Eigen::MatrixXd> eliminated(const std::vector<TrialLinear>& trials, Eigen::Index first,
                                        Eigen::Index count, const Eigen::VectorXd& prior_information);

// Information matrix and score vector of some columns, summed over the trials.
struct Pooled {
  Eigen::MatrixXd information;
  Eigen::VectorXd score;
};
Pooled pooled(const std::vector<Eigen::MatrixXd>& grams, const std::vector<Eigen::Index>& columns);

// Joint fit of a group of columns, with ridge `prior_information` on each.
struct GroupGain {
  Eigen::VectorXd size;    // Fitted coefficient of each column.
  double gain = 0.0;       // Drop of the deviance.
  TrialEvidence evidence;  // One entry per trial, along the fitted direction.
};
GroupGain group_gain(const std::vector<Eigen::MatrixXd>& grams, const std::vector<Eigen::Index>& columns,
                     double prior_information);

// Leave-one-out gain: sum over trials of the drop of each trial's deviance if the sizes are fitted to the
// other trials, with prior `prior_information`. Each size is shrunk by 1 - (posterior variance / prior
// variance), so directions that the other trials do not show predict nothing.
struct HeldOut {
  double gain = 0.0;
  std::vector<double> of_trial;
};
HeldOut held_out_gain(const std::vector<Eigen::MatrixXd>& grams, const std::vector<Eigen::Index>& columns,
                      const Eigen::MatrixXd& prior_information);

// Parameter sets of a candidate with its amplitudes at zero: all shapes typical, then one set for each listed
// value (`EffectParameter::shapes`). A list on an amplitude gives that amplitude those sizes.
std::vector<std::vector<double>> shape_choices(const Candidate& candidate);
// Step of an amplitude, in typical sizes, for the finite difference of its signature.
double signature_step(const Candidate& candidate, const std::vector<double>& choice, std::size_t amplitude);

// A candidate in the linear approximation at a point that does not contain it.
struct Screened {
  std::size_t candidate = 0;
  std::vector<double> values;  // Start values for a fit.
  double gain = 0.0;
  TrialEvidence evidence;
  double typicals = 0.0;  // Size of the first amplitude, in typical sizes.
};

// All candidates that the point does not contain, largest gain first. `columns`: derivatives by the nuisance
// parameters, null for the problem's own. `signatures`: taken at this point or near it.
std::vector<Screened> screen(const Problem& problem, const Point& point,
                             const std::vector<KeptColumns>* columns, const Signatures& signatures);

}  // namespace sandhopper::diagnose
