#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tests/unit/diagnose_prepared.hpp"
#include "tools/diagnose/evidence/beside.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/fit/fit.hpp"

// The search over sets of effects.
namespace sandhopper::diagnose {
namespace {

TEST(DiagnoseSearch, FitsEveryOtherEffectBesideTheBestSet) {
  const Problem problem = prepared(drops(dragged));
  Search search(problem, {.fits_per_screen = 1, .fits_of_singles = 1});
  search.run(null_point(problem));
  const auto best = search.best().set;
  ASSERT_EQ(best.size(), 1u);
  const auto beside = [&](std::size_t candidate) {
    auto set = best;
    set.push_back(candidate);
    std::ranges::sort(set);
    return search.sets().contains(set);
  };
  std::size_t before = 0, after = 0;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) before += c != best.front() && beside(c);
  search.fit_every_other();
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) after += c != best.front() && beside(c);
  EXPECT_LT(before, 4u);
  EXPECT_EQ(after, search.screened(best).size());
  EXPECT_EQ(search.best().set, best) << "nothing else is missing";
}

TEST(DiagnoseSearch, ASearchOfSinglesGoesOnWithLargerSets) {
  const Problem problem = prepared(drops(dragged));
  Search search(problem, {.most_effects = 1});
  search.run(null_point(problem));
  const auto largest = [&] {
    std::size_t size = 0;
    for (const auto& [set, fit] : search.sets()) size = std::max(size, set.size());
    return size;
  };
  EXPECT_EQ(largest(), 1u);
  search.widen(2);
  EXPECT_EQ(largest(), 2u);
}

// So much is unexplained that the weights of all sets are nearly equal.
TEST(DiagnoseSearch, AClassHoldsNoNameThatExplainsNothing) {
  constexpr double kRemainder = 1e6;
  const Problem problem = prepared(drops(dragged));
  Search all(problem, {.most_effects = 1});
  const auto best = all.run(null_point(problem)).set;
  ASSERT_EQ(best.size(), 1u);
  all.name_nothing();
  all.fit_every_other();  // beside nothing: every effect alone
  ASSERT_EQ(all.best().set, best);
  std::size_t useless = 0;
  for (const auto& [set, fit] : all.sets())
    useless += fit.fit.status != FitStatus::failed && all.criterion(fit) > all.criterion(all.null());
  EXPECT_GT(useless, 0u);
  const auto belief = posterior(problem, all, kRemainder);
  const auto names = belief.alternatives.find(best.front());
  if (names == belief.alternatives.end()) return;
  for (const auto name : names->second)
    EXPECT_LE(all.criterion(all.sets().at({name})), all.criterion(all.null()))
        << problem.candidates[name].label();
}

// A large fault of the accelerometer explains nothing in the heights. So it does not widen the class of a
// small fault of the heights.
TEST(DiagnoseSearch, AStrongEffectElsewhereDoesNotWidenAClass) {
  constexpr double kBias_mps2 = 1.0, kScale = 1.002;
  const auto class_size = [&](double bias_mps2) {
    auto recordings = drops([](double, double, double) { return 0.0; }, 1, 8, kScale);
    recordings.belief.numbers["medium.density_kg_per_m3"] = 0.0;
    for (auto& belief : recordings.beliefs) belief = recordings.belief;
    for (auto& trial : recordings.trials)
      for (auto& a : trial.channels.at("accel_mps2")) a += bias_mps2;
    const Problem problem = prepared(recordings);
    Search search(problem, {.most_effects = 2});
    search.run(null_point(problem));
    search.fit_every_other();
    const auto belief = posterior(problem, search, 0.0);
    for (const auto candidate : search.best().set) {
      if (problem.candidates[candidate].label() != "tof.scale[height_m]") continue;
      const auto names = belief.alternatives.find(candidate);
      return names == belief.alternatives.end() ? 1 : 1 + static_cast<int>(names->second.size());
    }
    return 0;
  };
  const int alone = class_size(0.0);
  EXPECT_GT(alone, 0);
  EXPECT_EQ(class_size(kBias_mps2), alone);
}

// A name that the search chose is not more probable than the sets that hold it, or an alternative of it. Sets
// that the criterion excludes do not count, and nothing becomes more probable.
TEST(DiagnoseSearch, TheEvidenceLimitsHowProbableANameIs) {
  // So weak a drag that other effects come near enough to be fitted completely.
  Problem problem = prepared(drops([](double t, double h, double v) { return 0.03 * dragged(t, h, v); }));
  Search search(problem, {.most_effects = 2});
  search.run(null_point(problem));
  std::vector<std::pair<double, std::size_t>> names;  // best first
  for (const auto& [set, fit] : search.sets())
    if (set.size() == 1 && !fit.rough && fit.fit.status != FitStatus::failed)
      names.emplace_back(search.criterion(fit), set.front());
  std::ranges::sort(names);
  ASSERT_GT(names.size(), 1u);
  const auto right = names.front().second, wrong = names.back().second;
  const auto limited = [&](std::size_t name, double from, double apart,
                           std::vector<std::size_t> alternatives = {}) {
    EXPECT_TRUE(search.name({name}));
    Posterior belief;
    belief.apart = apart;
    belief.mass[name] = from;
    belief.alternatives[name] = std::move(alternatives);
    std::vector<std::string> log;
    limit_by_evidence(problem, search, belief, log);
    return belief.mass[name];
  };
  constexpr double kEverySet = 1e9, kNoOther = -1e9;
  EXPECT_GT(limited(right, 0.98, kEverySet), 0.95);
  EXPECT_EQ(limited(right, 0.4, kEverySet), 0.4);
  EXPECT_LT(limited(wrong, 0.98, kEverySet), 1e-3);
  EXPECT_EQ(limited(wrong, 0.98, kNoOther), 0.98);
  EXPECT_GT(limited(wrong, 0.98, kEverySet, {right}), 0.95);
}

}  // namespace
}  // namespace sandhopper::diagnose
