#pragma once
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

// Evidence for one effect of a fitted set, the others and the tolerances free to take its place.
struct EffectEvidence {
  std::size_t candidate = 0;
  TrialEvidence evidence;
  double gain = 0.0;     // what the deviance would rise by without it, linearly
  double p_value = 1.0;  // trials as units, for all candidates together
  double flip_p_value = 1.0;
  double dispersion = 1.0;  // between trials over what the noise alone would give, not below 1
  double typicals = 0.0;    // |size| of the first amplitude
  bool at_bound = false;
  bool too_small = false;  // to be named, though it may be there
  bool unnoticed = false;  // explains no more than two simulations differ by
  bool weak = false;       // enough to be named alone, not beside others
};

struct SetFit {
  std::vector<std::size_t> set;  // sorted
  Fit fit;
  std::vector<EffectEvidence> evidence;
  double dispersion = 1.0;  // the mean of the effects'
  bool rough = false;       // only tried: finished before it can be the answer
  bool judged = false;
  std::vector<double> beside;  // deviances of the sets without one effect each, when it was judged
  bool needed = false;         // every effect stands on its own; known once judged
  bool sound = false;          // would be needed if none were too small
  bool hopeless = false;       // an effect is far from that
};

struct SearchOptions {
  std::size_t most_effects = 3;
  std::size_t beam = 2;
  std::size_t proposals = 0;  // sets from a linear approximation at the best point, tried at the end
  std::size_t fits_per_screen = 6;
  std::size_t fits_of_singles = 20;  // of the first screen: what it says of hoppers is often far off
  bool second_starts = true;  // where the first fit fell short of what its linear approximation promised
  bool straight = false;      // start from the believed nuisances, too
  double hopeless = 0.03;  // of the largest gain on the screen: less is not fitted, but for the first three
  std::function<void(double share, const char* what)> progress = [](double, const char*) {};
};

// Forward search over sets of effects with a beam, exchanges and deletions; every set that was tried is kept.
class Search {
 public:
  Search(const Problem& problem, const SearchOptions& options) : problem_(&problem), options_(options) {}

  // From what is already known at `start` (nuisances): the set that explains most with every effect needed.
  // `seeds`: sets to begin with, where their fits may start.
  const SetFit& run(const Point& start, const std::vector<Point>& seeds = {});

  // Where a law of free form beside the best set gains this much: the set that holds the best one and
  // explains as much, each of its effects certain though too small to be named otherwise, becomes the best.
  // False when there is none.
  bool name_small(double gain);

  // Nothing is named after all.
  void name_nothing() { best_.clear(); }

  // Where the fits of the sets with the smallest criterion stand, of those that come near.
  std::vector<Point> best_points(std::size_t count) const;

  const SetFit& best() const { return sets_.at(best_); }
  const SetFit& null() const { return sets_.at({}); }
  const std::map<std::vector<std::size_t>, SetFit>& sets() const { return sets_; }
  const std::vector<Screened>& screened(const std::vector<std::size_t>& set);

  // Penalised deviance: smaller is better. All sets share one dispersion, that of the set that fits best, or
  // a set that fits badly would be forgiven for it.
  double criterion(const SetFit& fit) const;
  double dispersion() const { return dispersion_; }

 private:
  double criterion(const SetFit& fit, double dispersion) const;
  double cost_of_an_effect() const;  // of the criterion, with one parameter
  double cost_of_a_parameter() const;
  void evaluate(const SetFit& from, const Screened& added);
  void evaluate_straight(const SetFit& from);
  bool is_bent(const Fit& fit) const;
  bool unbends(const Fit& without, const Fit& with) const;
  void judge(SetFit& fit);
  std::vector<double> deviances_without_one(const SetFit& fit) const;
  bool is_to_be_judged(const SetFit& fit) const;
  void expand(const std::vector<std::size_t>& from, std::size_t fits);
  void restart_null();
  void exchange();
  void prune();
  bool try_proposals();
  bool fit_part(const SetFit& whole, const std::vector<std::size_t>& part);
  const std::vector<KeptColumns>* columns_for(const std::vector<std::size_t>& set) const;
  Fit fit_at(const Point& start, FitOptions options = {}) const;
  void finish(SetFit& fit) const;
  void borrow(SetFit& fit) const;
  void finish_rivals();
  void grow_best();
  void settle_best();
  void choose_best();

  const Problem* problem_;
  SearchOptions options_;
  std::map<std::vector<std::size_t>, SetFit> sets_;
  std::map<std::vector<std::size_t>, std::vector<Screened>> screens_;
  // Sets from which effects were tried at the believed nuisances, with their deviance then.
  std::map<std::vector<std::size_t>, double> straight_;
  std::vector<std::size_t> best_;
  std::vector<KeptColumns> columns_;  // at the best set; empty: it is the null
  double dispersion_ = 1.0;
};

}  // namespace sandhopper::diagnose
