#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/fit/linearise.hpp"
#include "tools/diagnose/fit/problem.hpp"
#include "tools/diagnose/fit/signatures.hpp"
#include "tools/diagnose/fit/statistics.hpp"

namespace sandhopper::diagnose {

// Pooled linear algebra over trials: columns are residual, then directions. What a point already fits (its
// own parameters, tolerances) is eliminated over all trials together, with its priors.
//   A'_t = T' A_t T,  T subtracts from each column its pooled regression on the eliminated ones
std::vector<Eigen::MatrixXd> eliminated(const std::vector<TrialLinear>& trials, Eigen::Index first,
                                        Eigen::Index count, const Eigen::VectorXd& prior_information);

// Information and score of some columns, over all trials.
struct Pooled {
  Eigen::MatrixXd information;
  Eigen::VectorXd score;
};
Pooled pooled(const std::vector<Eigen::MatrixXd>& grams, const std::vector<Eigen::Index>& columns);

// What a group of columns explains together (ridge `prior_information` each), trial by trial.
struct GroupGain {
  Eigen::VectorXd size;    // of each column
  double gain = 0.0;       // drop of the deviance
  TrialEvidence evidence;  // along the fitted direction
};
GroupGain group_gain(const std::vector<Eigen::MatrixXd>& grams, const std::vector<Eigen::Index>& columns,
                     double prior_information);

// Sum over trials of the drop of each trial's deviance when the sizes come from the other trials only, with
// `prior_information`. A size counts by the share of its prior variance that the others took away: where they
// say nothing, nothing is predicted.
struct HeldOut {
  double gain = 0.0;
  std::vector<double> of_trial;
};
HeldOut held_out_gain(const std::vector<Eigen::MatrixXd>& grams, const std::vector<Eigen::Index>& columns,
                      const Eigen::MatrixXd& prior_information);

// Parameters of a candidate with its amplitudes off: shapes as typical, and once more for every value of the
// shape that has a list of them; what has a list of sizes is on at those.
std::vector<std::vector<double>> shape_choices(const Candidate& candidate);
// The part of its typical size at which an amplitude's signature is taken with these shapes.
double signature_step(const Candidate& candidate, const std::vector<double>& choice, std::size_t amplitude);

// A candidate as it looks in a linear approximation at a point that does not contain it.
struct Screened {
  std::size_t candidate = 0;
  std::vector<double> values;  // where a fit may start
  double gain = 0.0;
  TrialEvidence evidence;
  double typicals = 0.0;  // size of the first amplitude
};

// All candidates that the point does not hold, the largest gain first.
// `columns`: derivatives by the nuisances; the problem's own where null. `signatures`: of this point or one
// near it.
std::vector<Screened> screen(const Problem& problem, const Point& point,
                             const std::vector<KeptColumns>* columns, const Signatures& signatures);

}  // namespace sandhopper::diagnose
