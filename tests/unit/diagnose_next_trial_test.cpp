#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_json.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"

namespace sandhopper::diagnose {
namespace {

using ::testing::HasSubstr;

// A tenth more drag than believed, or equally a body that is a tenth lighter.
Recordings more_drag() {
  auto r = drops([](double, double, double v) { return -0.5 * 1.2 * 0.01 * 0.55 * std::abs(v) * v; });
  r.belief.numbers["medium.drag_coefficient"] = 0.5;
  for (auto& belief : r.beliefs) belief.numbers["medium.drag_coefficient"] = 0.5;
  return r;
}

// As more_drag(), in a lab that has weights and can throw the body down.
Recordings more_drag_with_payloads() {
  auto r = more_drag();
  r.available["payload_kg"] = {{0.1, 0.2, 0.6}, false, {}};
  r.available["release_speed_mps"] = {{0.0, 8.0}, true, {}};
  return r;
}

TEST(DiagnoseNextTrial, TellsAnErrorOfTheMassFromDragByAPayload) {
  const auto d = diagnose(more_drag_with_payloads());
  ASSERT_EQ(d.detail, Detail::one_of_class);
  EXPECT_EQ(d.next.kind, "drop");
  ASSERT_TRUE(d.next.setup.contains("payload_kg"));
  EXPECT_THAT(d.next.setup.at("payload_kg"), ::testing::AnyOf(0.1, 0.2, 0.6));
  EXPECT_GT(d.next.settles, 0.8);
  EXPECT_LE(d.next.settles, d.next.splits);
  EXPECT_EQ(d.next.purpose, "split");
  EXPECT_FALSE(d.next.beyond_recorded) << "the campaign lists payloads and speeds";
  EXPECT_THAT(d.next.why, HasSubstr(" the body "));
  EXPECT_TRUE(d.next.why.starts_with(d.next.order + ": ")) << d.next.why;
  EXPECT_THAT(d.next.why, HasSubstr(d.next.channel));
  ASSERT_GT(d.next.time_s.size(), 20u);
  ASSERT_EQ(d.next.by_first.size(), d.next.time_s.size());
  double apart = 0.0;
  for (std::size_t i = 0; i < d.next.time_s.size(); ++i)
    apart = std::max(apart, std::abs(d.next.by_first[i] - d.next.by_second[i]));
  // Hundreds of samples decide together; a single sample need not.
  EXPECT_GT(apart, 0.3 * d.next.noise);
}

// A lab without weights gets the set-up that would help as information, not as a proposal to buy one.
TEST(DiagnoseNextTrial, ProposesNoSetUpThatTheLabDoesNotHave) {
  const auto d = diagnose(more_drag());
  ASSERT_EQ(d.detail, Detail::one_of_class);
  EXPECT_FALSE(d.next.setup.contains("payload_kg"));
  EXPECT_TRUE(d.next.setup.empty()) << "drag over mass is the same in every drop: " << d.next.why;
  EXPECT_THAT(d.next.why, HasSubstr("lists under [available] a trial would: "));
  EXPECT_THAT(d.next.why, HasSubstr("payload"));
}

// No drop without a payload tells drag from mass, but a balance or a force gauge does. No chance is stated:
// nothing was simulated.
TEST(DiagnoseNextTrial, IsATestOnTheBenchWhereNoTrialWithinReachTellsTheClass) {
  const auto d = diagnose(more_drag());
  ASSERT_EQ(d.detail, Detail::one_of_class);
  EXPECT_EQ(d.next.purpose, "split");
  EXPECT_THAT(d.next.order, ::testing::AnyOf(HasSubstr("Weigh the body"), HasSubstr("Tow the body")));
  EXPECT_TRUE(d.next.why.starts_with(d.next.order + ": ")) << d.next.why;
  EXPECT_THAT(d.next.why, HasSubstr("It distinguishes "));
  const auto told = to_json(d).at("next_trial");
  EXPECT_EQ(told.at("why"), d.next.why);
  EXPECT_EQ(told.at("purpose"), "split");
  EXPECT_FALSE(told.contains("probability_it_splits"));
  EXPECT_FALSE(told.contains("beyond_recorded"));
  EXPECT_THAT(to_text(d), HasSubstr("next   " + d.next.order + ":\n"));
}

// Air slows the fall by a third. A planned trial must last until the body lands according to the corrected
// model, not four times a free fall, and must not count rows below the ground.
TEST(DiagnoseNextTrial, PlansADropThatAirSlowsUntilItLands) {
  constexpr double kDrag_kg_per_m = 0.044, kBelieved_kg_per_m = 0.04, kMass_kg = 0.2;
  auto recordings = drops([](double, double, double v) { return -kDrag_kg_per_m * std::abs(v) * v; });
  recordings.belief.numbers["medium.drag_coefficient"] = kBelieved_kg_per_m / (0.5 * 1.2 * 0.01);
  std::ranges::fill(recordings.beliefs, recordings.belief);
  recordings.available["payload_kg"] = {{0.1, 0.2, 0.6}, false, {}};
  recordings.available["release_speed_mps"] = {{0.0, 8.0}, true, {}};
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.next.purpose, "split");
  ASSERT_EQ(d.next.kind, "drop");
  const auto& setup = d.next.setup;
  const double height_m = setup.at("release_height_m"), speed_mps = setup.at("release_speed_mps");
  const double mass_kg = kMass_kg + (setup.contains("payload_kg") ? setup.at("payload_kg") : 0.0);
  double h = height_m, v = -speed_mps, landing_s = 0.0;
  for (constexpr double kStep_s = 1e-4; h > 0.0; landing_s += kStep_s) {
    v += kStep_s * (-9.81 - kDrag_kg_per_m * std::abs(v) * v / mass_kg);
    h += kStep_s * v;
  }
  EXPECT_GT(landing_s, 1.05 * (std::sqrt(speed_mps * speed_mps + 2.0 * 9.81 * height_m) - speed_mps) / 9.81);
  ASSERT_FALSE(d.next.time_s.empty());
  EXPECT_NEAR(d.next.time_s.back(), landing_s, 0.1 * landing_s);
}

// A drive that acts late and a torque with early time stamps give the same recordings of the axis, whatever
// is recorded. An oscilloscope tells them apart.
TEST(DiagnoseNextTrial, IsATestOnAnOscilloscopeWhereOnlyTheClocksAreInDoubt) {
  auto recordings = swings([](double, double, double) { return 0.0; }, 1, 10);
  for (auto& trial : recordings.trials) {
    auto& torque = trial.channels["torque_Nm"];
    torque.erase(torque.begin(), torque.begin() + 2);
    torque.insert(torque.end(), 2, torque.back());
  }
  const auto d = diagnose(recordings);
  ASSERT_EQ(d.detail, Detail::one_of_class);
  EXPECT_EQ(d.next.purpose, "split");
  EXPECT_TRUE(d.next.setup.empty());
  EXPECT_EQ(d.next.splits, 0.0);
  EXPECT_THAT(d.next.why, HasSubstr("oscilloscope"));
  EXPECT_THAT(d.next.why, HasSubstr("no single one of"));
  EXPECT_EQ(to_json(d).at("next_trial").at("setup"), nlohmann::ordered_json({{"kind", d.next.kind}}));
}

TEST(DiagnoseNextTrial, TightensTheWidestBoundWhereNothingIsMissing) {
  const auto d = diagnose(drops([](double, double, double) { return 0.0; }));
  ASSERT_EQ(d.verdict, Verdict::consistent);
  ASSERT_GT(d.absent.front().typicals, 0.5);
  // The widest bound of all, also of an effect that is not listed because its prior alone bounds it closer.
  EXPECT_THAT(d.next.why, HasSubstr("he widest bound is that of"));
  for (const auto& bound : d.absent | std::views::drop(1))
    EXPECT_THAT(d.next.why, Not(HasSubstr(bound.id + ";")));
  // Its size stands in the table of bounds, which holds for all of them together; another number of it here
  // would contradict that.
  EXPECT_THAT(d.next.why, HasSubstr("% of its width"));
  EXPECT_THAT(d.next.why, Not(HasSubstr("times its typical size")));
}

TEST(DiagnoseNextTrial, NarrowsTheIntervalOfTheOneExplanation) {
  const auto d = diagnose(drops([](double, double, double v) { return -0.01 * v; }));
  ASSERT_EQ(d.detail, Detail::known);
  EXPECT_EQ(d.next.kind, "drop");
  EXPECT_THAT(d.next.why, HasSubstr("air.linear_drag"));
}

TEST(DiagnoseNextTrial, PlansAMotionOfAnAxis) {
  const auto d = diagnose(swings([](double, double velocity, double) { return -0.05 * velocity; }));
  ASSERT_EQ(d.verdict, Verdict::missing_physics);
  EXPECT_TRUE(d.next.kind == "motion" || d.next.kind == "hold") << d.next.kind;
  EXPECT_GT(d.next.setup.at("duration_s"), 0.0);
}

// A phone that falls: no height is recorded or stated, so none is proposed.
TEST(DiagnoseNextTrial, ProposesNoReleaseHeightThatNobodyKnows) {
  auto r = drops([](double, double, double v) { return -0.5 * 1.2 * 0.01 * 0.5 * std::abs(v) * v; });
  for (auto& trial : r.trials) {
    trial.setup = {{"release_speed_mps", 0.0}};
    trial.channels.erase("height_m");
  }
  const auto d = diagnose(r);
  ASSERT_EQ(d.next.kind, "drop") << d.next.why;
  EXPECT_FALSE(d.next.setup.contains("release_height_m"));
}

// A pendulum that is let go and has no drive: the torque of a free axis is 0 in every row.
TEST(DiagnoseNextTrial, DrivesNoAxisThatHasNoDrive) {
  auto r = swings([](double, double w, double torque) { return -torque - 0.05 * w; });
  for (auto& trial : r.trials) std::ranges::fill(trial.channels["torque_Nm"], 0.0);
  const auto d = diagnose(r);
  for (const char* driven : {"position_rad", "amplitude_rad", "frequency_Hz", "speed_radps"})
    EXPECT_FALSE(d.next.setup.contains(driven)) << d.next.why;
}

TEST(DiagnoseNextTrial, StandsInTheAnswersFileWithItsSetUp) {
  const auto json = to_json(diagnose(more_drag_with_payloads()));
  const auto& setup = json.at("next_trial").at("setup");
  EXPECT_EQ(setup.at("kind"), "drop");
  EXPECT_TRUE(setup.at("release_height_m").is_number());
  EXPECT_FALSE(json.at("next_trial").at("why").get<std::string>().empty());
}

// Contents of a page: both simulations beside the recording, and errors in every phase with samples.
TEST(DiagnoseReport, ShowsTracesWhoseErrorFallsToTheFloorOnHeldOutTrials) {
  const auto d = diagnose(drops([](double, double, double v) { return -0.01 * v; }));
  ASSERT_FALSE(d.traces.empty());
  const auto rms = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
  };
  for (const auto& trace : d.traces) {
    EXPECT_LE(trace.time_s.size(), 500u);
    ASSERT_EQ(trace.floor.size(), trace.time_s.size());
    EXPECT_LT(rms(trace.measured, trace.after),
              1.3 * rms(trace.floor, std::vector<double>(trace.floor.size())));
  }
  const auto& most = d.traces.front();
  EXPECT_GT(rms(most.measured, most.before), 3.0 * rms(most.floor, std::vector<double>(most.floor.size())));
  ASSERT_FALSE(d.where.empty());
  for (const auto& where : d.where) EXPECT_EQ(where.port, "body");
  for (const auto& error : d.phase_errors) EXPECT_LT(error.after, 1.4 * error.floor) << error.channel;
}

// In every trial the release height is 1 cm larger than in its set-up; the spread is 5 mm.
TEST(DiagnoseReport, TellsTheMeanOfWhatDiffersFromTrialToTrial) {
  auto recordings = drops([](double, double, double) { return 0.0; });
  for (auto& trial : recordings.trials) trial.setup["release_height_m"] -= 0.01;
  const auto d = diagnose(recordings);
  const auto height = std::ranges::find_if(
      d.trial_to_trial, [](const TrialToTrial& told) { return told.name == "release_height_m"; });
  ASSERT_NE(height, d.trial_to_trial.end());
  EXPECT_DOUBLE_EQ(height->believed_sd, 0.005);
  EXPECT_NEAR(height->mean_before, 0.01, 0.004);
  EXPECT_NEAR(height->sd_before, 0.005, 0.003);
  EXPECT_EQ(to_json(d).at("trial_to_trial").size(), d.trial_to_trial.size());
}

}  // namespace
}  // namespace sandhopper::diagnose
