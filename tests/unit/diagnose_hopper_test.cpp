#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/diagnose_effect_sizes.hpp"
#include "tests/unit/diagnose_hops.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/prepare.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kSwitch_s = 0.25;

// Its phases are imposed.
Trial hop(std::uint64_t seed = 0, double release_m = 0.04) {
  static const std::vector<PhaseChange> kPhases{{0.0, HopperPhase::flight},
                                                {0.09, HopperPhase::compression},
                                                {kSwitch_s, HopperPhase::extension},
                                                {0.36, HopperPhase::flight}};
  HopperRun run = hop_from(release_m, 0.45);
  run.phases = &kPhases;
  return recorded(run, {}, seed);
}

// Largest difference of a motor's current between recording and simulation.
double largest_error_A(const Trial& trial) {
  std::string why;
  const auto plant = make_plant(PlantKind::hopper);
  const auto channels = plant->channels();
  const auto current = static_cast<std::uint32_t>(
      std::find(channels.begin(), channels.end(), "motor_left_current_A") - channels.begin());
  const auto model = plant->trial(trial, Belief{}, why);
  EXPECT_NE(model, nullptr) << why;
  std::vector<double> predicted(model->rows.size());
  model->predict({}, std::vector<double>(model->nuisance_count(), 0.0), predicted);
  double largest = 0.0;
  for (std::size_t i = 0; i < predicted.size(); ++i)
    if (model->rows[i].channel == current)
      largest = std::max(largest, std::abs(predicted[i] - model->rows[i].measured));
  return largest;
}

// The command jumps where the phase changes. Without the leg's angle just there (an encoder that shows the
// same count at its turning point passes for stuck) the jump came gradually: several amperes off.
TEST(DiagnoseHopper, AnglesThatAreMissingBeforeTheSwitchDoNotSmearTheCommand) {
  Trial trial = hop();
  const double whole_A = largest_error_A(trial);
  for (std::size_t i = 0; i < trial.time_s.size(); ++i)
    if (trial.time_s[i] > kSwitch_s - 5.5e-3 && trial.time_s[i] < kSwitch_s - 0.5e-3)
      for (const char* side : {"motor_left_", "motor_right_"})
        trial.channels[std::string(side) + "position_rad"][i] = std::numeric_limits<double>::quiet_NaN();
  const double without_A = largest_error_A(trial);
  std::printf("current off by %.3f A at most, by %.3f A with five angles missing\n", whole_A, without_A);
  EXPECT_LT(whole_A, 0.5);
  EXPECT_LT(without_A, whole_A + 0.05);
}

// Whatever a hopper may have changes nothing when it is off, and something at its typical size.
TEST(DiagnoseHopper, EveryEffectActsAtItsTypicalSizeAndNothingActsAtNone) {
  Recordings r;
  r.plant = PlantKind::hopper;
  for (std::uint64_t i = 1; i <= 3; ++i) {
    r.trials.push_back(hop(i, 0.02 + 0.02 * static_cast<double>(i)));
    auto& setup = r.trials.back().setup;
    setup["pushes_since_preparation"] = static_cast<double>(i - 1);
    setup["wait_s"] = 10.0 * static_cast<double>(i);
    setup["bed_depth_m"] = 0.08;
    r.beliefs.push_back(r.belief);
  }
  const auto prepared = prepare(r);
  const auto& problem = prepared.problem;
  ASSERT_GT(problem.candidates.size(), 40u);
  std::size_t compliant = 0;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    const auto& candidate = problem.candidates[c];
    compliant += candidate.effect->id == "joint.backlash" || candidate.effect->id == "leg.series_elasticity";
    EXPECT_LT(largest_change(problem, c, 0.0), 1e-3) << candidate.label();
    EXPECT_GT(largest_change(problem, c, 1.0), 0.05) << candidate.label();
  }
  EXPECT_EQ(compliant, 2u);
}

}  // namespace
}  // namespace sandhopper::diagnose
