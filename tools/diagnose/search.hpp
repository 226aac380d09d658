#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "tools/diagnose/evidence/log_evidence.hpp"
#include "tools/diagnose/fit.hpp"
#include "tools/diagnose/screen.hpp"

namespace sandhopper::diagnose {

// A set of effects, fitted.
struct SetFit {
  std::vector<std::size_t> set;  // sorted
  Fit fit;
  bool rough = false;  // only tried: finished before it can be the answer
  bool judged = false;
  LogEvidence evidence{};                  // once judged
  double log_mass = -std::numeric_limits<double>::infinity();  // with the prior of the set
  double unknown_log_mass = -std::numeric_limits<double>::infinity();  // the same with an unknown law beside it
  double mass_of_both() const {
    const double most = std::max(log_mass, unknown_log_mass);
    return most + std::log(std::exp(log_mass - most) + std::exp(unknown_log_mass - most));
  }
};

struct SearchOptions {
  std::size_t most_effects = 3;
  std::size_t beam = 2;
  std::size_t proposals = 0;  // sets from a linear approximation at the best point, tried at the end
  std::size_t fits_per_screen = 6;
  std::size_t fits_of_singles = 20;  // of the first screen: what it says of hoppers is often far off
  bool second_starts = true;  // where the first fit fell short of what its linear approximation promised
  bool straight = false;      // start from the believed nuisances, too
  const Signatures* of_null = nullptr;  // at the start, or near it; made there where null
  double hopeless = 0.03;  // of the largest gain on the screen: less is not fitted, but for the first three
  std::function<void(double share, const char* what)> progress = [](double, const char*) {};
};

// Forward search over sets of effects with a beam, exchanges and deletions; every set that was tried is kept.
class Search {
 public:
  Search(const Problem& problem, const SearchOptions& options) : problem_(&problem), options_(options) {}

  // From what is already known at `start` (nuisances): the set with the largest posterior mass.
  // `seeds`: sets to begin with, where their fits may start.
  const SetFit& run(const Point& start, const std::vector<Point>& seeds = {});

  // With another noise model than before: sets that came near are fitted again from where they stood, the
  // first one is the best so far; `at_best`: signatures there.
  const SetFit& revise(const Point& null, const std::vector<Point>& seeds, const Signatures& at_best);

  // Where the fits of the sets with the smallest criterion stand, of those that come near.
  std::vector<Point> best_points(std::size_t count) const;

  std::optional<std::vector<std::size_t>> likeliest_of_size(std::size_t size) const;
  void take(const std::vector<std::size_t>& set) { best_ = set; }  // as the best

  const SetFit& best() const { return sets_.at(best_); }
  const SetFit& null() const { return sets_.at({}); }
  const std::map<std::vector<std::size_t>, SetFit>& sets() const { return sets_; }
  const std::vector<Screened>& screened(const std::vector<std::size_t>& set);

  // What a fit may be worth before it is judged, as a deviance: smaller is better.
  double criterion(const SetFit& fit) const;

 private:
  double cost_of_an_effect() const;  // of the criterion, with one parameter
  double cost_of_a_parameter() const;
  void evaluate(const SetFit& from, const Screened& added);
  void evaluate_straight(const SetFit& from);
  bool is_bent(const Fit& fit) const;
  bool unbends(const Fit& without, const Fit& with) const;
  void judge(SetFit& fit);
  void expand(const std::vector<std::size_t>& from, std::size_t fits);
  void restart_null();
  void exchange();
  bool try_proposals();
  bool fit_part(const SetFit& whole, const std::vector<std::size_t>& part);
  const std::vector<KeptColumns>* columns_for(const std::vector<std::size_t>& set) const;
  Fit fit_at(const Point& start, FitOptions options = {}) const;
  void finish(SetFit& fit);
  bool borrow(SetFit& fit) const;
  bool may_be_answer(SetFit& fit);
  void finish_rivals();
  void settle_best();
  void refit_parts(const std::vector<std::size_t>& set);
  void settle_parts();
 public:
  bool trials_agree(const SetFit& fit) const;
 private:
  void choose_best();

  const Problem* problem_;
  SearchOptions options_;
  std::map<std::vector<std::size_t>, SetFit> sets_;
  std::map<std::vector<std::size_t>, std::vector<Screened>> screens_;
  // Sets from which effects were tried at the believed nuisances, with their deviance then.
  std::map<std::vector<std::size_t>, double> straight_;
  std::vector<std::size_t> best_;
  std::vector<KeptColumns> columns_;  // at the best set; empty: it is the null
};

}  // namespace sandhopper::diagnose
