#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/next/planned_trials.hpp"

namespace sandhopper::diagnose {

// Explanations that the recordings leave in one effect's place: the best set first, then each set that has
// the effect exchanged for another that explains as much.
struct Rivals {
  std::vector<const SetFit*> fits;
  std::vector<std::string> names;  // of the effects in which they differ
  const SetFit* null = nullptr;    // what is believed

  std::size_t size() const { return fits.size(); }
};
std::vector<Rivals> rivals_of(const Problem& problem, const Search& search, const Posterior& belief);

// What a planned trial would say of rivals: one linearisation at the first of them that holds every other's
// difference to it and everybody's derivatives, the trial's nuisances integrated out.
class Contest {
 public:
  Contest(const Problem& problem, const PlannedTrials& planned, std::size_t trial, const Rivals& rivals,
          double dispersion);

  // Rise of the deviance of the wrong one of two, the smaller of both ways round, over the dispersion.
  double lambda(std::size_t i, std::size_t j) const;
  // Deviance that the first explains in the trial, over the dispersion.
  double explained() const { return rise(0, fits_.size() - 1); }
  // Chance that their deviances differ by more than `apart`, the parameters of i as uncertain as they are.
  double settles(std::size_t i, std::size_t j, double apart) const;

  // Predictions for the trial's rows: by i, and by j refitted to look like it.
  struct Predictions {
    std::vector<double> first, second;
  };
  Predictions predictions(const Problem& problem, const PlannedTrials& planned, std::size_t i,
                          std::size_t j) const;

 private:
  struct Columns {
    Eigen::Index difference = 0;  // to the first; 0 for the first itself
    Eigen::Index from = 0, count = 0;
  };
  double rise(std::size_t i, std::size_t j) const;  // of j's deviance when i is true
  Eigen::VectorXd between(std::size_t i, std::size_t j) const;
  Eigen::MatrixXd left(std::size_t j) const;

  std::vector<const SetFit*> fits_;  // the rivals, then what is believed
  std::vector<Direction> directions_;
  std::vector<Columns> columns_;
  Eigen::MatrixXd transform_, gram_;
  std::size_t trial_;
  double dispersion_;
};

}  // namespace sandhopper::diagnose
