#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_json.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"

// A limit of time ends the search at a whole step; the answer is what is known so far.
namespace sandhopper::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Recordings with_drag() {
  return drops([](double, double, double v) { return -0.5 * 1.2 * 0.01 * 0.5 * std::abs(v) * v; });
}

// The limit passes at the question after the first `most`; `asked` counts the questions.
EngineOptions limited(std::size_t& asked, std::size_t most) {
  EngineOptions options;
  options.stop = [&asked, most] { return ++asked > most; };
  return options;
}

TEST(DiagnoseLimit, SaysThatNothingIsKnownIfItPassesAtOnce) {
  std::size_t asked = 0;
  const auto d = diagnose(with_drag(), limited(asked, 0));
  EXPECT_EQ(d.verdict, Verdict::insufficient_time);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_FALSE(d.stopped_in.empty());
  EXPECT_EQ(to_json(d)["verdict"], "insufficient_time");
  EXPECT_EQ(to_json(d)["stopped_by_limit_in"], d.stopped_in);
  EXPECT_THAT(to_text(d), HasSubstr("limit of time ended the search"));
  ASSERT_FALSE(d.residuals.empty()) << "those of the belief are known";
  for (const auto& row : d.residuals) EXPECT_NEAR(row.after, row.before, row.noise_sd);
}

TEST(DiagnoseLimit, NamesWhatIsFoundSoFarAndWhatWasNotLookedAt) {
  std::size_t all = 0, asked = 0;
  const auto whole = diagnose(with_drag(), limited(all, 1'000'000));
  EXPECT_TRUE(whole.stopped_in.empty());
  EXPECT_FALSE(to_json(whole).contains("stopped_by_limit_in"));
  EXPECT_THAT(to_text(whole), Not(HasSubstr("limit")));
  ASSERT_GT(all, 3U);
  const auto d = diagnose(with_drag(), limited(asked, all - 1));
  EXPECT_EQ(d.verdict, Verdict::missing_physics);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects.front().id, "air.quadratic_drag");
  EXPECT_LE(d.effects.front().probability, 0.7) << "what is left was not looked at";
  EXPECT_GT(whole.effects.front().mass, 0.95);
  EXPECT_FALSE(d.stopped_in.empty());
  EXPECT_TRUE(d.absent.empty());
  EXPECT_TRUE(d.next.kind.empty());
  EXPECT_FALSE(d.corrected_model_toml.empty());
  EXPECT_THAT(to_text(d), HasSubstr("another set of effects may explain"));
  EXPECT_EQ(asked, all) << "nothing is asked once the limit has passed";
}

TEST(DiagnoseLimit, WithTooFewTrialsToLeaveOneOutNoNameIsSure) {
  const auto surest_of = [](std::size_t trials) {
    auto r = with_drag();
    r.trials.resize(trials);
    r.beliefs.resize(trials);
    double surest = 0.0;
    for (const auto& effect : diagnose(r).effects) surest = std::max(surest, effect.probability);
    return surest;
  };
  EXPECT_LE(surest_of(2), 0.7);
  EXPECT_GT(surest_of(3), 0.7);
}

TEST(DiagnoseLimit, ProgressNamesTheStepAndNeverFalls) {
  EngineOptions options;
  double last = 0.0;
  std::set<std::string> steps;
  std::size_t falls = 0;
  options.progress = [&](double share, const char* step) {
    falls += share < last;
    last = share;
    steps.insert(step);
  };
  diagnose(with_drag(), options);
  EXPECT_EQ(falls, 0U);
  EXPECT_EQ(last, 1.0);
  for (const auto* step : {"fitting the belief as it is", "estimating the noise", "screening effects",
                           "fitting effects", "bounding absent effects", "choosing the next trial"})
    EXPECT_TRUE(steps.contains(step)) << step;
}

}  // namespace
}  // namespace sandhopper::diagnose
