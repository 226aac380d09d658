#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/diagnose/answer/diagnosis_text.hpp"
#include "tools/diagnose/engine.hpp"
#include "tools/diagnose/plants/falling_body/falling_body_recording.hpp"
#include "tools/diagnose/plants/falling_body/falling_simulation.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kMass_kg = 0.5, kArea_m2 = 1.5e-3, kDensity_kg_per_m3 = 998.0, kGravity_mps2 = 9.81;

struct Entry {
  double added_mass_kg = 0.0, over_m = 0.006, drag_coefficient = 0.0;
};

// A body falls freely for 60 ms and enters water at 2 to 5 m/s; accelerometer at 2 kHz with 0.05 m/s^2 of
// noise. The integrator (semi-implicit, 20 us) is independent of the diagnosis.
Recordings entries(const Entry& e, std::size_t trials = 8) {
  constexpr double kStep_s = 2e-5, kFree_s = 0.06, kEnd_s = 0.16;
  Recordings r;
  r.plant = PlantKind::falling_body;
  r.belief.numbers = {{"gravity_mps2", kGravity_mps2},
                      {"body.mass_kg", kMass_kg},
                      {"body.frontal_area_m2", kArea_m2},
                      {"medium.density_kg_per_m3", kDensity_kg_per_m3},
                      {"sensors.accel_noise_mps2", 0.05}};
  for (std::size_t i = 0; i < trials; ++i) {
    Random random(11, i);
    Trial trial;
    trial.name = std::to_string(i + 1);
    trial.kind = "drop";
    const double impact_mps = 2.0 + static_cast<double>(i % 4);
    trial.setup["impact_speed_mps"] = impact_mps;
    double depth = -impact_mps * kFree_s + 0.5 * kGravity_mps2 * kFree_s * kFree_s,
           v = impact_mps - kGravity_mps2 * kFree_s + 0.005 * random.normal();
    const long steps = std::lround(kEnd_s / kStep_s);
    for (long step = 0; step < steps; ++step) {
      double a = kGravity_mps2;
      if (depth > 0.0) {
        const double left = std::exp(-depth / e.over_m), mass = e.added_mass_kg * (1.0 - left);
        const double drag_N = 0.5 * kDensity_kg_per_m3 * kArea_m2 * e.drag_coefficient * v * v;
        a = (kMass_kg * kGravity_mps2 - drag_N - e.added_mass_kg / e.over_m * left * v * v) /
            (kMass_kg + mass);
      }
      if (step % 25 == 0) {
        trial.time_s.push_back(kStep_s * static_cast<double>(step));
        trial.channels["accel_mps2"].push_back(kGravity_mps2 - a + 0.05 * random.normal());
      }
      v += kStep_s * a;
      depth += kStep_s * v;
    }
    r.trials.push_back(std::move(trial));
    r.beliefs.push_back(r.belief);
  }
  return r;
}

const FoundEffect* found(const Diagnosis& d, const std::string& id) {
  const auto it = std::ranges::find(d.effects, id, &FoundEffect::id);
  return it == d.effects.end() ? nullptr : &*it;
}

TEST(DiagnoseLiquid, WhatTheBodyTakesAlongIsTakenUpLittleByLittle) {
  const auto d = diagnose(entries({.added_mass_kg = 0.01, .drag_coefficient = 0.45}));
  const auto* mass = found(d, "fluid.added_mass");
  const auto* drag = found(d, "air.quadratic_drag");
  ASSERT_TRUE(mass != nullptr && drag != nullptr) << to_text(d);
  EXPECT_GT(mass->probability, 0.5);
  EXPECT_GT(drag->probability, 0.5);
  // In the recordings the drag begins at once; the diagnosis lets it grow over a quarter of the body.
  EXPECT_NEAR(mass->parameters[0].value, 0.01, 0.003);
  EXPECT_NEAR(mass->parameters[1].value, 0.006, 0.002);
  EXPECT_NEAR(drag->parameters[0].value, 0.45, 0.05);
}

TEST(DiagnoseLiquid, TheBlowIsFoundWhereABodyFellFreely) {
  const auto recordings = entries({.added_mass_kg = 0.01}, 4);
  for (const auto& trial : recordings.trials) {
    Samples accels{trial.time_s, trial.channels.at("accel_mps2")};
    const auto entry_s = liquid_entry_s(accels, kGravity_mps2);
    ASSERT_TRUE(entry_s.has_value());
    EXPECT_NEAR(*entry_s, 0.06, 1e-3);
    for (double& a : accels.value) a += kGravity_mps2;  // the body is held, so it reads its weight
    EXPECT_FALSE(liquid_entry_s(accels, kGravity_mps2).has_value());
  }
}

TEST(DiagnoseLiquid, AShareOfTheBodyIsWetted) {
  EXPECT_EQ(wetted_share(-0.01, 0.04), 0.0);
  EXPECT_DOUBLE_EQ(wetted_share(0.01, 0.04), 0.25);
  EXPECT_EQ(wetted_share(0.1, 0.04), 1.0);
  EXPECT_EQ(wetted_share(-0.01, 0.0), 1.0);  // the medium is everywhere
  Belief belief;
  belief.numbers["body.frontal_area_m2"] = 1e-2 * M_PI;
  EXPECT_DOUBLE_EQ(body_length_m(belief), 0.2);
}

}  // namespace
}  // namespace sandhopper::diagnose
