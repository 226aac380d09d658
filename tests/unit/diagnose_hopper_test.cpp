#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/plants/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper_simulation.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/prepare.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kSwitch_s = 0.25;

// A hop as it would be recorded, with its commands; phases are imposed. `seed` 0: without noise.
Trial hop(std::uint64_t seed = 0, double release_m = 0.04) {
  const std::vector<PhaseChange> phases{{0.0, HopperPhase::flight},
                                        {0.09, HopperPhase::compression},
                                        {kSwitch_s, HopperPhase::extension},
                                        {0.36, HopperPhase::flight}};
  const Belief belief;
  HopperRun run;
  run.world = world_of(belief, {});
  const Leg leg(run.world.robot.leg);
  run.start.foot_z_m = release_m;
  run.start.angle_rad = leg.angle_at_length(run.world.controller.compression_length_m);
  run.to_s = 0.45;
  run.phases = &phases;
  const auto traces = simulate_hopper(run, {});
  Trial trial;
  trial.kind = "hop";
  trial.setup["release_height_m"] = run.start.foot_z_m;
  const double motors = run.world.robot.leg.motor_count;
  Random random(seed, 0);
  const auto put = [&](const std::string& channel, double value, double noise) {
    trial.channels[channel].push_back(value + (seed == 0 ? 0.0 : noise * random.normal()));
  };
  const double g = run.world.gravity_mps2;
  for (std::size_t i = 0; i < 450; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    trial.time_s.push_back(t);
    trial.channels["phase"].push_back(static_cast<double>(phase_at(phases, t)));
    put("imu_body_accel_z_mps2", traces.body_accel_mps2.at(t) + g, 0.05);
    put("imu_foot_accel_z_mps2", traces.foot_accel_mps2.at(t) + g, 0.05);
    put("load_cell_force_N", traces.force_N.at(t), 0.3);
    put("tof_height_m", traces.body_z_m.at(t), 3e-3);
    for (const std::string side : {"left", "right"}) {
      const std::string motor = "motor_" + side;
      put(motor + "_position_rad", traces.angle_rad.at(t), 2e-4);
      put(motor + "_velocity_radps", traces.rate_radps.at(t), 0.1);
      put(motor + "_current_A",
          traces.current_torque_Nm.at(t) / motors / run.world.motor.torque_constant_Nm_per_A, 0.1);
      trial.channels[motor + "_temperature_C"].push_back(40.0 + 300.0 * release_m);
      trial.channels["command_" + side + "_torque_Nm"].push_back(traces.command_torque_Nm.at(t) / motors);
    }
  }
  return trial;
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
    double off = 0.0, typical = 0.0;
    for (const auto& model : problem.trials) {
      const std::vector<double> nuisances(model->nuisance_count(), 0.0);
      const auto with = [&](double typicals) {
        std::vector<double> values;
        for (std::size_t i = 0; i < candidate.parameters.size(); ++i) {
          const auto& p = candidate.parameters[i];
          values.push_back(is_amplitude(candidate.parameters, i)
                               ? std::clamp(typicals * p.typical, p.low, p.high)
                               : std::clamp(p.typical, p.low, p.high));
        }
        std::vector<double> out(model->rows.size());
        model->predict(edits_for(problem, {{c}, {values}}, {}), nuisances, out);
        return out;
      };
      std::vector<double> plain(model->rows.size());
      model->predict({}, nuisances, plain);
      const auto none = with(0.0), some = with(1.0);
      for (std::size_t k = 0; k < plain.size(); ++k) {
        const double sd = problem.floor_sd[model->rows[k].channel];
        off = std::max(off, std::abs(none[k] - plain[k]) / sd);
        typical = std::max(typical, std::abs(some[k] - plain[k]) / sd);
      }
    }
    EXPECT_LT(off, 1e-3) << candidate.label();
    EXPECT_GT(typical, 0.05) << candidate.label();
  }
  EXPECT_EQ(compliant, 2u);
}

}  // namespace
}  // namespace sandhopper::diagnose
