#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tests/unit/diagnose_effect_sizes.hpp"
#include "tools/diagnose/evidence/proposals.hpp"
#include "tools/diagnose/evidence/screen.hpp"
#include "tools/diagnose/fit/fit.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// Properties that every effect of every plant must have.
namespace sandhopper::diagnose {
namespace {

Recordings recordings_of(PlantKind plant) {
  const auto none = [](double, double, double) { return 0.0; };
  if (plant == PlantKind::falling_body) {
    // Includes the assumed drag, because the accelerometer shows nothing in a fall without it.
    auto r = drops([](double, double, double v) { return -0.5 * 1.2 * 0.01 * 0.5 * std::abs(v) * v; }, 3, 5);
    r.belief.numbers["medium.drag_coefficient"] = 0.5;
    for (auto& belief : r.beliefs) belief = r.belief;
    return r;
  }
  if (plant == PlantKind::rotary_axis) return swings(none, 3, 4);
  return presses([](double, double) { return 0.0; }, 3, 6);
}

// State of a moving, loaded body at a port.
PortState moving(LawPort port, double v) {
  if (port == LawPort::body) return BodyState{.height_m = 0.01, .velocity_mps = v, .depth_m = 3.0};
  if (port == LawPort::axis) return AxisState{.angle_rad = 0.01, .velocity_radps = v, .torque_Nm = 3.0};
  return GroundState{.depth_m = 0.01, .speed_mps = v, .virgin = v > 0.0 ? 1.0 : 0.0, .quasi_static_N = 3.0};
}

TEST(EffectParameters, AreFittedInOneScaleAndReportedInAnother) {
  const EffectParameter tilt{.typical = 0.01, .power = 0.5};
  EXPECT_NEAR(tilt.reported(0.04), 0.2, 1e-12);
  EXPECT_NEAR(tilt.value_of(0.2), 0.04, 1e-12);
  EXPECT_NEAR(tilt.typicals(0.04), 2.0, 1e-12);
  const EffectParameter stiffness{.typical = 1e-5, .power = -1.0};
  EXPECT_NEAR(stiffness.reported(2e-5), 5e4, 1e-6);
  EXPECT_NEAR(stiffness.value_of(5e4), 2e-5, 1e-15);
  EXPECT_NEAR(stiffness.typicals(2e-5), 2.0, 1e-12);
}

class EveryEffect : public ::testing::TestWithParam<PlantKind> {};

// Sizes at which an effect shows, in typical sizes. A clock that is off as clocks usually are does not show
// in a trial of a second.
double visible_size(const Candidate& candidate) { return candidate.effect->id == "clock.drift" ? 4.0 : 1.0; }

TEST_P(EveryEffect, ChangesNothingWhenOffAndSomethingAtItsTypicalSize) {
  const auto prepared = prepare(recordings_of(GetParam()));
  const auto& problem = prepared.problem;
  ASSERT_GT(problem.candidates.size(), 8u);
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    EXPECT_LT(largest_change(problem, c, 0.0), 1e-3) << problem.candidates[c].label();
    EXPECT_GT(largest_change(problem, c, visible_size(problem.candidates[c])), 0.05)
        << problem.candidates[c].label();
  }
}

TEST_P(EveryEffect, BringsNoEnergyWhereItIsAFriction) {
  const auto prepared = prepare(recordings_of(GetParam()));
  const auto& problem = prepared.problem;
  const std::set<std::string> frictions{"axis.stribeck",   "axis.load_dependent",    "air.quadratic_drag",
                                        "terrain.viscous", "terrain.quadratic_drag", "terrain.suction"};
  for (const auto& candidate : problem.candidates) {
    if (!frictions.contains(candidate.effect->id)) continue;
    Edits edits;
    candidate.effect->apply(problem.context, candidate.channel, values_of(candidate, 1.0), edits);
    for (const auto& [port, law] : edits.laws) {
      if (port == LawPort::ground_tension) continue;  // a limit of the force, not a force
      for (double v = -2.0; v <= 2.0; v += 0.1) {
        // At the bed a force upward is positive, but speed counts downward.
        const double power = law(moving(port, v)) * (name_of(port).starts_with("ground") ? -v : v);
        EXPECT_LE(power, 1e-12) << candidate.label() << " at " << v;
      }
    }
  }
}

TEST_P(EveryEffect, StandsFirstOnTheScreenWhenAlone) {
  auto prepared = prepare(recordings_of(GetParam()));
  auto& problem = prepared.problem;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    for (std::size_t t = 0; t < problem.trials.size(); ++t) {
      const auto with = predicted(problem, t, c, 0.3 * visible_size(problem.candidates[c]));
      for (std::size_t k = 0; k < with.size(); ++k) problem.trials[t]->rows[k].measured = with[k];
    }
    // The tolerance of a channel's time could explain a skew as well, so it is removed here.
    const bool skew = problem.candidates[c].effect->id == "clock.skew";
    const auto held = skew ? std::exchange(problem.tolerances, {}) : problem.tolerances;
    const auto found = screen(problem, null_point(problem), nullptr,
                              signatures_at(problem, null_point(problem), {.laws = false}));
    problem.tolerances = held;
    const auto own =
        std::find_if(found.begin(), found.end(), [&](const Screened& s) { return s.candidate == c; });
    ASSERT_NE(own, found.end());
    // A clock that is off as usual: the accelerometer does not show it, and the priors of sizes decide.
    if (problem.candidates[c].effect->id == "clock.drift" && found.front().gain < 1.0) continue;
    // Another effect may be equivalent, but none may be much better.
    EXPECT_GT(own->gain, 0.9 * found.front().gain)
        << problem.candidates[c].label() << " behind " << problem.candidates[found.front().candidate].label();
  }
}

INSTANTIATE_TEST_SUITE_P(OfAPlant, EveryEffect,
                         ::testing::Values(PlantKind::falling_body, PlantKind::rotary_axis,
                                           PlantKind::intruder));

// An effect that is equivalent to one of the best set is found by exchanging the two, starting from the best
// fit.
TEST(DiagnoseSearch, ProposalsHoldTheBestSetWithOneEffectExchanged) {
  const auto recordings = presses([](double, double speed) { return 8.0 * std::max(0.0, speed); }, 2, 6);
  const Prepared prepared = prepare(recordings);
  const Problem& problem = prepared.problem;
  const auto index = [&](const std::string& id) {
    for (std::size_t c = 0; c < problem.candidates.size(); ++c)
      if (problem.candidates[c].effect->id == id) return c;
    throw std::runtime_error("no candidate " + id);
  };
  const auto viscous = index("terrain.viscous"), quadratic = index("terrain.quadratic_drag");
  Point start = null_point(problem);
  start.hypothesis.candidates = {viscous};
  start.hypothesis.values = {values_of(problem.candidates[viscous], 1.0)};
  const Fit fit = fit_from(problem, start);
  const auto proposals = propose(problem, fit.point, 2, 6, 10.0);
  EXPECT_TRUE(std::ranges::any_of(proposals, [&](const Proposal& p) {
    return p.start.candidates == std::vector<std::size_t>{quadratic};
  }));
}

}  // namespace
}  // namespace sandhopper::diagnose
