#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_json.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/model/quantity.hpp"
#include "tools/diagnose/next/choice.hpp"

namespace sandhopper::diagnose {
namespace {

using ::testing::Each;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::Not;

// Trials from 2 m only, let go at rest.
Recordings low_drops() {
  auto r = drops([](double, double, double) { return 0.0; }, 1, 8);
  std::erase_if(r.trials, [](const Trial& trial) { return trial.setup.at("release_height_m") > 2.5; });
  r.beliefs.resize(r.trials.size());
  return r;
}

// Values of a set-up key over all trials that can be planned.
std::set<double> planned(const Recordings& r, const Reach& reach, const std::string& key) {
  std::set<double> values;
  for (const auto& one : make_plant(r.plant)->doable(r.trials, r.belief, {}, reach))
    if (const auto found = one.trial.setup.find(key); found != one.trial.setup.end())
      values.insert(found->second);
  return values;
}

Reach reach_of(const Recordings& r) { return {r.trials, r.available, r.words}; }

TEST(DiagnoseDoable, DropsKeepToWhatWasRecorded) {
  const auto r = low_drops();
  EXPECT_THAT(planned(r, reach_of(r), "release_height_m"), ::testing::ElementsAre(2.0));
  EXPECT_THAT(planned(r, reach_of(r), "release_speed_mps"), ::testing::ElementsAre(0.0));
  EXPECT_THAT(planned(r, reach_of(r), "payload_kg"), IsEmpty());
}

TEST(DiagnoseDoable, DropsOfFreeNumbersFillARoomButNeedNoPayload) {
  const auto r = low_drops();
  const auto reach = reach_of(r).with_free_numbers();
  EXPECT_THAT(planned(r, reach, "release_height_m"), Each(Le(2.5)));
  EXPECT_GT(planned(r, reach, "release_speed_mps").size(), 1u);
  EXPECT_THAT(planned(r, reach, "payload_kg"), IsEmpty());
  EXPECT_THAT(planned(r, reach_of(r).with_any_part(), "payload_kg"), Not(IsEmpty()));
}

TEST(DiagnoseDoable, DropsStayWithinTheLimitsThatTheCampaignStates) {
  auto r = low_drops();
  r.available["release_speed_mps"] = {{0.0, 1.0}, true, {}};
  r.available["release_height_m"] = {{0.5, 4.0}, true, {}};
  const auto reach = reach_of(r).with_any_part();
  EXPECT_THAT(planned(r, reach, "release_height_m"), Each(::testing::AllOf(Ge(0.5), Le(4.0))));
  EXPECT_THAT(planned(r, reach, "release_height_m"), ::testing::Contains(4.0));
  EXPECT_THAT(planned(r, reach, "release_speed_mps"), Each(Le(1.0)));
}

TEST(DiagnoseDoable, MotionsStayWithinTheLimitsThatTheCampaignStates) {
  auto r = swings([](double, double, double) { return 0.0; });
  r.available["frequency_Hz"] = {{0.2, 1.0}, true, {}};
  r.available["amplitude_rad"] = {{0.1, 0.5}, true, {}};
  const auto reach = reach_of(r).with_free_numbers();
  EXPECT_THAT(planned(r, reach, "amplitude_rad"), Each(Le(0.5)));
  EXPECT_THAT(planned(r, reach, "frequency_Hz"), Each(Le(1.0)));
}

TEST(DiagnoseDoable, ATorqueRangeThatNobodyStatesExcludesNoMotion) {
  auto r = swings([](double, double, double) { return 0.0; });
  for (const double range_Nm : {0.0, 100.0}) {
    r.belief.numbers["sensors.torque_range_Nm"] = range_Nm;
    EXPECT_THAT(planned(r, reach_of(r).with_free_numbers(), "amplitude_rad"), Not(IsEmpty())) << range_Nm;
  }
  // Without free numbers the largest recorded torque is the limit.
  r.belief.numbers["sensors.torque_range_Nm"] = 0.0;
  r.available["amplitude_rad"] = {{100.0}, false, {}};
  r.available["frequency_Hz"] = {{3.0}, false, {}};
  EXPECT_THAT(planned(r, reach_of(r), "frequency_Hz"), IsEmpty());
  EXPECT_THAT(planned(r, reach_of(r).with_free_numbers(), "frequency_Hz"), Not(IsEmpty()));
  r.belief.numbers["sensors.torque_range_Nm"] = 1e-9;
  EXPECT_THAT(planned(r, reach_of(r).with_free_numbers(), "amplitude_rad"), IsEmpty());
}

NextTrial low_drop(double height_m) {
  NextTrial next;
  next.purpose = "split";
  next.kind = "drop";
  next.setup = {{"release_height_m", height_m}};
  next.order = trial_in_words(next.kind, {}, next.setup, Telling::order);
  next.why = "height_m tells one from the other.";
  return next;
}

TEST(DiagnoseDoable, ASetUpBeyondTheRecordedOnesIsMarkedAsSuch) {
  const auto r = low_drops();
  Diagnosis d;
  d.next = low_drop(2.4);
  complete(reach_of(r), d.next);
  EXPECT_TRUE(d.next.beyond_recorded);
  EXPECT_THAT(d.next.why, ::testing::StartsWith("Drop the body from 2.4 m: height_m tells"));
  EXPECT_THAT(d.next.why, HasSubstr("beyond the recorded ones (release height 2 m)"));
  EXPECT_EQ(to_json(d).at("next_trial").at("beyond_recorded"), true);
  EXPECT_THAT(to_text(d), HasSubstr("next   Drop the body from 2.4 m:\n       height_m tells"));
}

TEST(DiagnoseDoable, ASetUpThatWasRecordedOrIsListedIsNotMarked) {
  auto r = low_drops();
  NextTrial recorded = low_drop(2.0), listed = low_drop(2.4);
  complete(reach_of(r), recorded);
  r.available["release_height_m"] = {{0.5, 4.0}, true, {}};
  complete(reach_of(r), listed);
  for (const auto& next : {recorded, listed}) {
    EXPECT_FALSE(next.beyond_recorded) << next.why;
    EXPECT_THAT(next.why, Not(HasSubstr("beyond")));
  }
}

}  // namespace
}  // namespace sandhopper::diagnose
