#pragma once
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"

namespace sandhopper::diagnose {

// Evidence for one effect of a fitted set, with the other effects and the tolerances refitted in its place.
struct EffectEvidence {
  std::size_t candidate = 0;
  TrialEvidence evidence;
  double gain = 0.0;  // Rise of the deviance without the effect, in the linear approximation.
  // Student's t over trials, Bonferroni-corrected for all candidates; the larger of those without and with
  // form errors of the other effects (form_error.hpp).
  double p_value = 1.0;
  // Sign-flip test over trials, family-wise.
  double flip_p_value = 1.0;
  double dispersion = 1.0;  // Variance between trials / variance from the noise alone, >= 1.
  double typicals = 0.0;    // |first amplitude| in typical sizes
  bool at_bound = false;
  bool too_small = false;  // Below the size from which an effect is named; it may still be there.
  bool unnoticed = false;  // Explains no more than two programs with the same equations differ by.
  bool weak = false;       // Enough evidence to be named alone, not beside other effects.
};

// One fitted set of effects.
struct SetFit {
  std::vector<std::size_t> set;  // Candidate indices, sorted.
  Fit fit;
  std::vector<EffectEvidence> evidence;
  double dispersion = 1.0;  // Mean of the effects' dispersions.
  bool rough = false;       // Fitted with few iterations only; `finish` completes the fit.
  // Fitted from the prior means of the nuisance parameters: the fit does not depend on that of the null.
  bool straight = false;
  bool judged = false;
  std::vector<double> beside;  // Deviances of the sets without one of the effects, at the time of judging.
  bool needed = false;    // Every effect is significant, large enough and noticeable; valid after `judge`.
  bool sound = false;     // Like `needed`, but small effects are allowed.
  bool refused = false;   // Far less probable than the best set (`name_likeliest`).
  bool hopeless = false;  // An effect is so far from needed that a better fit is not worth its cost.
};

struct SearchOptions {
  std::size_t most_effects = 3;  // Largest number of effects in a set.
  std::size_t beam = 2;          // Number of sets of each size that are extended by a further effect.
  std::size_t proposals = 0;     // Number of sets from `propose` that are fitted at the end.
  std::size_t fits_per_screen = 6;
  // Fits in the first screen. On hoppers that screen is often far off, so there are many.
  std::size_t fits_of_singles = 20;
  // Fit again from other sizes if the first fit gains much less than the linear estimate.
  bool second_starts = true;
  bool costly = false;    // Simulations are slow: fewer and less exact fits.
  bool free_null = true;  // Look for a better minimum of the null; a search before may have found it.
  bool straight = false;  // Also start from the prior means of the nuisance parameters.
  // A candidate with less than this fraction of the largest gain on the screen is not fitted; the first three
  // always are.
  double hopeless = 0.03;
  std::function<void(double share, const char* what)> progress = [](double, const char*) {};
};

// Forward beam search over sets of effects, with exchanges and deletions. Every fitted set is kept.
class Search {
 public:
  Search(const Problem& problem, const SearchOptions& options) : problem_(&problem), options_(options) {}

  // `over` is asked before each fit of a set. Once true, the search ends with the sets fitted so far.
  void stop_when(std::function<bool()> over) { is_over_ = std::move(over); }

  // Returns the set that explains most, with every effect needed. `start`: a point without effects whose
  // nuisance parameters are the start values. `seeds`: sets to fit first, from these points.
  const SetFit& run(const Point& start, const std::vector<Point>& seeds = {});

  // Continues after run() with sets of more effects.
  void widen(std::size_t most_effects);

  // Fits every other effect beside the best set, and in place of its weakest effect. A law that is not linear
  // may gain much more than its derivative at zero promises; only the fit shows it, and bounds it.
  void fit_every_other();

  // `gain`: held-out gain of a law of free form beside the best set. If a larger set explains nearly as much
  // and every effect in it is significant, it becomes the best set, even if an effect is too small to be
  // named otherwise. Returns false if there is no such set.
  bool name_small(double gain);

  // Makes a fitted set the best one. False, and nothing is changed, if an effect of it stands at the end of
  // its range.
  bool name(const std::vector<std::size_t>& set);

  // A refused set is no alternative to the best one.
  void refuse(const std::vector<std::size_t>& set) { sets_.at(set).refused = true; }

  // Makes the empty set the best one.
  void name_nothing() { best_.clear(); }

  // Up to `count` fitted points whose deviance is near the best one's, smallest criterion first.
  std::vector<Point> best_points(std::size_t count) const;

  const SetFit& best() const { return sets_.at(best_); }
  const SetFit& null() const { return sets_.at({}); }
  const std::map<std::vector<std::size_t>, SetFit>& sets() const { return sets_; }
  const std::vector<Screened>& screened(const std::vector<std::size_t>& set);

  // Penalised deviance: smaller is better. All sets are compared with the same dispersion, that of the
  // best-fitting set: a set with its own dispersion would be rewarded for fitting badly.
  double criterion(const SetFit& fit) const;
  double dispersion() const { return dispersion_; }
  bool stopped() const { return stopped_; }  // True if it ended before its time.
  void set_stopped() { stopped_ = true; }    // A later search with better noise was ended in its place.

  // Derivatives by the nuisances that fits from this set use.
  const std::vector<KeptColumns>* columns_for(const std::vector<std::size_t>& set) const;

 private:
  bool over() { return stopped_ = stopped_ || is_over_(); }
  void grow_and_improve();
  void grow_sets();
  void improve();
  double criterion(const SetFit& fit, double dispersion) const;
  double cost_of_an_effect() const;  // Penalty per effect, including its first parameter.
  double cost_of_a_parameter() const;
  void evaluate(const SetFit& from, const Screened& added);
  void evaluate_straight(const SetFit& from);
  void fit_straight(const SetFit& from, const Point& start, const std::vector<KeptColumns>& columns,
                    double& closest);
  bool nuisances_have_absorbed(const Fit& fit) const;
  bool removes_common_shift(const Fit& without, const Fit& with) const;
  void judge(SetFit& fit);
  std::vector<double> deviances_without_one(const SetFit& fit) const;
  bool is_to_be_judged(const SetFit& fit) const;
  void expand(const std::vector<std::size_t>& from, std::size_t fits);
  void restart_null();
  void exchange();
  void fit_all_beside(const std::vector<std::size_t>& set);
  void complete();
  void prune();
  bool try_proposals();
  bool fit_part(const SetFit& whole, const std::vector<std::size_t>& part, const FitOptions& options = {});
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
  // Sets already screened at the prior means of the nuisance parameters, with their deviance at that time.
  std::map<std::vector<std::size_t>, double> straight_;
  std::vector<std::size_t> best_;
  std::vector<KeptColumns> columns_;  // Derivatives at the best set; empty while that is the null.
  double dispersion_ = 1.0;
  std::function<bool()> is_over_ = [] { return false; };
  bool stopped_ = false;
  double share_ = 0.0, share_of_screen_ = 0.0;  // Progress at the start of a screen, and its part.
};

}  // namespace sandhopper::diagnose
