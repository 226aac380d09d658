#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/plants/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper_simulation.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kSwitch_s = 0.25;

// A hop as it would be recorded without noise, with its commands; phases are imposed.
Trial hop() {
  const std::vector<PhaseChange> phases{{0.0, HopperPhase::flight},
                                        {0.09, HopperPhase::compression},
                                        {kSwitch_s, HopperPhase::extension},
                                        {0.36, HopperPhase::flight}};
  const Belief belief;
  HopperRun run;
  run.world = world_of(belief, {});
  const Leg leg(run.world.robot.leg);
  run.start.foot_z_m = 0.04;
  run.start.angle_rad = leg.angle_at_length(run.world.controller.compression_length_m);
  run.to_s = 0.45;
  run.phases = &phases;
  const auto traces = simulate_hopper(run, {});
  Trial trial;
  trial.kind = "hop";
  trial.setup["release_height_m"] = run.start.foot_z_m;
  const double motors = run.world.robot.leg.motor_count;
  for (std::size_t i = 0; i < 450; ++i) {
    const double t = 1e-3 * static_cast<double>(i);
    trial.time_s.push_back(t);
    trial.channels["phase"].push_back(static_cast<double>(phase_at(phases, t)));
    trial.channels["imu_foot_accel_z_mps2"].push_back(traces.foot_accel_mps2.at(t) + run.world.gravity_mps2);
    for (const std::string side : {"left", "right"}) {
      trial.channels["motor_" + side + "_position_rad"].push_back(traces.angle_rad.at(t));
      trial.channels["motor_" + side + "_velocity_radps"].push_back(traces.rate_radps.at(t));
      trial.channels["motor_" + side + "_current_A"].push_back(traces.current_torque_Nm.at(t) / motors /
                                                               run.world.motor.torque_constant_Nm_per_A);
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

}  // namespace
}  // namespace sandhopper::diagnose
