#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/signatures.hpp"

// Effects that act in a trial exactly as one of its nuisances does.
namespace sandhopper::diagnose {
namespace {

constexpr double kDerating_per_K = 1e-3, kRoom_C = 25.0;

// Six hops on beds that are alike, with motors that get warmer from trial to trial and lose torque.
Recordings warm_hops(double derating_per_K) {
  Recordings r;
  r.plant = PlantKind::hopper;
  r.belief.numbers = {{"spread.torque_constant_relative", 0.02}, {"spread.bed_stiffness_relative", 0.02}};
  const std::vector<PhaseChange> phases{
      {0.0, HopperPhase::flight}, {0.09, HopperPhase::compression}, {0.15, HopperPhase::extension}};
  for (std::uint64_t i = 0; i < 6; ++i) {
    Edits edits;
    edits.sensor_law("actuator", [=](const SensorState& s) {
      return -derating_per_K * (s.temperature_C - kRoom_C) * s.value;
    });
    HopperRun run = hop_from(0.02 + 0.01 * static_cast<double>(i), 0.4);
    run.world = world_of(r.belief, edits);
    run.phases = &phases;
    run.motor_temperature_C = 40.0 + 300.0 * run.start.foot_z_m;  // as recorded() writes it
    r.trials.push_back(recorded(run, edits, i + 1));
    r.beliefs.push_back(r.belief);
  }
  return r;
}

// The statement holds that a nuisance acts as an effect does: both predict the same rows.
TEST(DiagnoseLikeNuisance, PredictsTheSameRowsAsTheEffect) {
  constexpr double kShare = 0.5;  // of the effect's typical size
  const Prepared prepared = prepare(warm_hops(0.0));
  const Problem& problem = prepared.problem;
  std::size_t pairs = 0;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    const Candidate& candidate = problem.candidates[c];
    for (const auto& trial : problem.trials) {
      const auto alike = trial->like(candidate.label());
      if (!alike) continue;
      ++pairs;
      Point point = null_point(problem);
      const double size = kShare * candidate.parameters[0].typical;
      std::vector<double> moved(trial->nuisance_count(), 0.0);
      moved[alike->nuisance] = size * alike->per_unit;
      const auto by_nuisance = predicted(problem, *trial, {}, moved);
      point.hypothesis = {.candidates = {c}, .values = {{size}}};
      const auto by_effect =
          predicted(problem, *trial, edits_for(problem, point.hypothesis, point.tolerances),
                    std::vector<double>(moved.size(), 0.0));
      EXPECT_LT((by_effect - by_nuisance).cwiseAbs().maxCoeff(), 1e-9) << candidate.label() << trial->name;
      const auto at_rest = predicted(problem, *trial, {}, std::vector<double>(moved.size(), 0.0));
      EXPECT_GT((by_effect - at_rest).cwiseAbs().maxCoeff(), 1e-3) << candidate.label() << trial->name;
    }
  }
  EXPECT_EQ(pairs, 2 * problem.trials.size());  // the torque constant and its fall with temperature
}

// The spread of the torque constant takes up all that warm motors lose, so the residuals show nothing. The
// nuisances then grow with the temperature. With derivatives that differ a little between effect and nuisance
// the screen gave a hundredth of the true size and a bound below it.
TEST(DiagnoseLikeNuisance, AnEffectThatASpreadTakesUpIsScreenedAtItsSize) {
  Prepared prepared = prepare(warm_hops(kDerating_per_K));
  Problem& problem = prepared.problem;
  const Point point = settled_null(problem);
  const auto screened = screen(problem, point, nullptr, signatures_at(problem, point, {.laws = false}));
  const auto found = std::ranges::find_if(screened, [&](const Screened& s) {
    return problem.candidates[s.candidate].label() == "actuator.temperature";
  });
  ASSERT_NE(found, screened.end());
  const double typical = problem.candidates[found->candidate].parameters[0].typical;
  EXPECT_NEAR(found->typicals * typical, kDerating_per_K, 0.2 * kDerating_per_K);
  EXPECT_NEAR(found->evidence.size() * typical, kDerating_per_K, 0.2 * kDerating_per_K);
}

}  // namespace
}  // namespace sandhopper::diagnose
