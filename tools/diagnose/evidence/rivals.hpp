#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/next/planned_trials.hpp"

namespace sandhopper::diagnose {

// Explanations that the recordings do not tell apart: the best set first, then each set in which one of its
// effects is replaced by another that explains as much.
struct Rivals {
  std::vector<const SetFit*> fits;
  std::vector<std::string> names;  // Labels of the exchanged effects.
  const SetFit* null = nullptr;    // The belief without any effect.

  std::size_t size() const { return fits.size(); }
};
// One group for each effect of the best set that has alternatives.
std::vector<Rivals> rivals_of(const Problem& problem, const Search& search, const Posterior& belief);

// Power of a planned trial to separate rival explanations. It is linearised once, at the first rival. The
// columns are the other rivals' differences to it and the derivatives of all of them, with the trial's
// nuisance parameters integrated out.
class Contest {
 public:
  Contest(const Problem& problem, const PlannedTrials& planned, std::size_t trial, const Rivals& rivals,
          double dispersion);

  // Expected rise of the deviance of the wrong one of two rivals, divided by the dispersion: the smaller of
  // the two directions.
  double lambda(std::size_t i, std::size_t j) const;
  // Expected deviance that the first rival explains in the trial, divided by the dispersion.
  double explained() const { return rise(0, fits_.size() - 1); }
  // Probability that the two deviances differ by more than `apart` if i is true. The parameters of i are
  // drawn from their posterior.
  double settles(std::size_t i, std::size_t j, double apart) const;

  // Predictions for the trial's rows, in the channels' units: `first` by rival i, `second` by rival j
  // refitted to rival i's prediction.
  struct Predictions {
    std::vector<double> first, second;
  };
  Predictions predictions(const Problem& problem, const PlannedTrials& planned, std::size_t i,
                          std::size_t j) const;

 private:
  struct Columns {
    Eigen::Index difference = 0;  // Column of the difference to the first rival; 0 for the first itself.
    Eigen::Index from = 0, count = 0;
  };
  double rise(std::size_t i, std::size_t j) const;  // Rise of j's deviance if i is true.
  Eigen::VectorXd between(std::size_t i, std::size_t j) const;
  Eigen::MatrixXd left(std::size_t j) const;

  std::vector<const SetFit*> fits_;  // The rivals, then the null.
  std::vector<Direction> directions_;
  std::vector<Columns> columns_;
  Eigen::MatrixXd transform_, gram_;
  std::size_t trial_;
  double dispersion_;
};

}  // namespace sandhopper::diagnose
