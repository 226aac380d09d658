#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/diagnose_campaigns.hpp"
#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {
namespace {

// Balls of one drag that fall from 6 m, or are thrown up with 8 m/s, in air that rises with 0.5 m/s. Heights
// at 200 Hz with 4 mm of noise.
Recordings balls_in_a_draught() {
  constexpr double kGravity_mps2 = 9.81, kDrag_kg_per_m = 0.002, kDraught_mps = 0.5, kStep_s = 1e-4;
  Recordings r;
  r.plant = PlantKind::falling_body;
  for (std::size_t i = 0; i < 8; ++i) {
    Random random(3, i);
    const double mass_kg = 0.03 + 0.02 * static_cast<double>(i / 2);
    Trial trial;
    trial.name = std::to_string(i + 1);
    trial.kind = "drop";
    trial.setup = {{"release_height_m", i % 2 == 1 ? 1.0 : 6.0},
                   {"release_speed_mps", i % 2 == 1 ? 8.0 : 0.0},
                   {"mass_kg", mass_kg}};
    double h = trial.setup["release_height_m"] + 0.003 * random.normal();
    double v = trial.setup["release_speed_mps"] + 0.05 * random.normal();
    for (long step = 0; h > 0.1; ++step) {
      if (step % 50 == 0) {
        trial.time_s.push_back(kStep_s * static_cast<double>(step));
        trial.channels["height_m"].push_back(h + 0.004 * random.normal());
      }
      const double relative_mps = v - kDraught_mps;
      v -= kStep_s * (kGravity_mps2 + kDrag_kg_per_m / mass_kg * std::abs(relative_mps) * relative_mps);
      h += kStep_s * v;
    }
    r.trials.push_back(std::move(trial));
    r.beliefs.emplace_back();
    r.beliefs.back().numbers = {{"gravity_mps2", kGravity_mps2},
                                {"body.mass_kg", mass_kg},
                                {"body.frontal_area_m2", 0.01},
                                {"medium.density_kg_per_m3", 1.2},
                                {"medium.drag_coefficient", kDrag_kg_per_m / 0.006},
                                {"spread.release_height_m", 0.003},
                                {"spread.release_speed_mps", 0.05},
                                {"spread.height_scale_relative", 0.001},
                                {"sensors.height_noise_m", 0.004}};
  }
  r.belief = r.beliefs.front();
  return r;
}

// With some bounds that are tried the speed runs away. Steps that are divided without an end make this test
// run into its limit of time.
TEST(DiagnoseDraught, TheFlowOfTheAirIsNamed) {
  const auto d = diagnose(balls_in_a_draught());
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  EXPECT_EQ(d.effects.front().id, "fluid.flow") << to_text(d);
  const auto& flow = d.effects.front().parameters.front();
  EXPECT_LT(flow.low, 0.5);
  EXPECT_GT(flow.high, 0.5);
}

bool has_flow(const Problem& problem) {
  return std::ranges::find(problem.candidates, "fluid.flow", &Candidate::label) != problem.candidates.end();
}

// In falls alone a flow acts like linear drag, so it is no candidate.
TEST(DiagnoseDraught, FallsAloneHaveNoFlow) {
  const auto throws = balls_in_a_draught();
  EXPECT_TRUE(has_flow(prepare(throws).problem));
  auto falls = throws;
  std::erase_if(falls.trials, [](const Trial& trial) { return trial.setup.at("release_speed_mps") > 0.0; });
  falls.beliefs.resize(falls.trials.size());
  EXPECT_FALSE(has_flow(prepare(falls).problem));
}

}  // namespace
}  // namespace sandhopper::diagnose
