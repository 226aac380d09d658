#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "tools/experiment/paper/claims/claims.hpp"
#include "tools/experiment/paper/report.hpp"

namespace sandhopper::paper {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

// One repetition of the hop set, shared by the tests of this file.
const ProgrammeResults& small_programme() {
  static const ProgrammeResults results = run_programme(
      {.seeds = 1, .condition_seeds = 0, .threads = std::max(1U, std::thread::hardware_concurrency())});
  return results;
}

const std::vector<Claim>& table() {
  static const std::vector<Claim> claims = claim_table(small_programme());
  return claims;
}

double figure(const Claim& claim, std::string_view name) {
  for (const auto& one : claim.figures)
    if (one.name == name) return one.value;
  ADD_FAILURE() << "claim " << claim.number << " has no figure '" << name << "'";
  return std::nan("");
}

TEST(PaperProgramme, TheTableHasAll36ClaimsEachWithAFigureAndAReason) {
  ASSERT_EQ(table().size(), 36U);
  for (std::size_t i = 0; i < table().size(); ++i) {
    const auto& claim = table()[i];
    EXPECT_EQ(claim.number, static_cast<int>(i) + 1);
    EXPECT_FALSE(claim.figures.empty()) << claim.number;
    EXPECT_FALSE(claim.pass_line.empty()) << claim.number;
    EXPECT_FALSE(claim.why.empty()) << claim.number;
    std::set<std::string> names;
    for (const auto& one : claim.figures) {
      EXPECT_TRUE(std::isfinite(one.value)) << "claim " << claim.number << ": " << one.name;
      EXPECT_TRUE(names.insert(one.name).second) << "claim " << claim.number << ": twice " << one.name;
    }
  }
}

// Verdict of the simulation on each of the paper's claims. A change of plant or estimator that changes a
// verdict fails here.
TEST(PaperProgramme, VerdictsThatDoNotHangOnChance) {
  for (const int number :
       {3, 4, 5, 7, 8, 9, 10, 11, 12, 13, 15, 17, 18, 20, 22, 24, 26, 27, 28, 29, 31, 32, 33, 34, 36})
    EXPECT_EQ(table()[static_cast<std::size_t>(number - 1)].verdict, Verdict::comes_out) << number;
  for (const int number : {1, 2, 16, 25, 30, 35})
    EXPECT_EQ(table()[static_cast<std::size_t>(number - 1)].verdict, Verdict::only_if) << number;
  EXPECT_EQ(table()[5].verdict, Verdict::does_not);  // the inertia of the foot remains
}

TEST(PaperProgramme, AddedMassTakesAThirdAndMoreOffWhatTheMapLeavesFromSevenTenthsOn) {
  for (const auto& d : decomposition_by_speed(small_programme(), &HopResult::truth)) {
    if (d.speed_mps < 0.7) continue;
    EXPECT_THAT(d.drop_percent(), AllOf(Ge(30.0), Le(65.0))) << d.speed_mps;
    EXPECT_THAT(d.correlation, AllOf(Ge(0.7), Le(0.98))) << d.speed_mps;
    EXPECT_THAT(d.map_N, AllOf(Ge(1.5), Le(5.0))) << d.speed_mps;
  }
}

TEST(PaperProgramme, TheIntegratedGradientIsTheAddedMassWithinAFifthToThirtyMillimetres) {
  const auto& r = small_programme();
  const Bed bed(r.setup.world.terrain, r.setup.world.robot.leg.foot_radius_m);
  for (int mm = 1; mm <= 30; ++mm) {
    const double z = 1e-3 * mm;
    EXPECT_NEAR(r.map.added_mass_kg(z) / bed.added_mass_kg(z), 1.0, 0.20) << z;
  }
}

// An independent simulation gives 1521 N/m for slow strokes with an intercept, 1628 N/m through the origin,
// and 1525 N/m from the map.
TEST(PaperProgramme, StiffnessOfTheActuatorSetDependsOnItsDefinitionAsExpected) {
  const auto& k = small_programme().stiffness;
  EXPECT_NEAR(k.slow_free_intercept, 1521.0, 30.0);
  EXPECT_NEAR(k.slow_through_origin, 1628.0, 30.0);
  EXPECT_NEAR(k.map_coefficient, 1525.0, 30.0);
  EXPECT_THAT(k.fastest_free_intercept / k.slow_free_intercept, AllOf(Ge(0.78), Le(0.88)));
  EXPECT_THAT(small_programme().map.r_squared, AllOf(Ge(0.985), Le(0.998)));
}

TEST(PaperProgramme, AnEarlyPeakOnAStiffBedIsManyTimesHigher) {
  const auto& claim = table()[19];
  const double ratio = figure(claim, "peak on the stiff bed") / figure(claim, "peak at 1.0 m/s");
  EXPECT_THAT(ratio, AllOf(Ge(3.0), Le(15.0)));
}

TEST(PaperProgramme, TheAnswerDoesNotDependOnTheNumberOfThreads) {
  HopSetSetup setup{.seeds = 1, .trials_per_cell = 1, .threads = 1};
  const auto one = run_hop_set(setup, small_programme().map);
  setup.threads = 3;
  const auto three = run_hop_set(setup, small_programme().map);
  ASSERT_EQ(one.size(), three.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].errors.observer_N.squares, three[i].errors.observer_N.squares);
    EXPECT_EQ(one[i].truth.inertial_rms_N, three[i].truth.inertial_rms_N);
  }
}

TEST(PaperProgramme, NumbersAndPageHoldTheWholeTable) {
  const auto json = programme_json(small_programme(), table());
  ASSERT_EQ(json["claims"].size(), 36U);
  for (const auto& claim : json["claims"])
    for (const auto& one : claim["figures"]) EXPECT_TRUE(one["value"].is_number()) << claim["number"];
  EXPECT_EQ(json["treatments"].size(), treatment_cases().size());
  EXPECT_EQ(json.dump().find("⟦"), std::string::npos) << "the marks of equations belong to the page";
  const auto study = programme_report(small_programme(), table());
  EXPECT_EQ(study.sections.size(), 6U);
  EXPECT_EQ(study.verdict, summary(table()));
  EXPECT_NE(study.verdict.find(" of 36 claims hold, "), std::string::npos) << study.verdict;
  const auto& claims = std::get<StudyTable>(study.sections.front().items.at(1));
  EXPECT_EQ(claims.rows.size(), 36U);
  EXPECT_EQ(claims.row_marks.size(), 36U);
}

}  // namespace
}  // namespace sandhopper::paper
