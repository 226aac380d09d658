#include <fmt/format.h>

#include <algorithm>

#include "tools/calibrate/torque_constant.hpp"
#include "tools/cli/calibration.hpp"
#include "tools/cli/failure.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  double peak_torque_Nm = 0.8;
  int repeats = 4;
};

std::vector<calibrate::Step> steps(const Options& options, const CalibrationInput& input) {
  if (options.peak_torque_Nm > input.robot.limits.motor_torque_Nm)
    throw Failure(ExitCode::usage,
                  fmt::format("--peak-torque-Nm {} is more than limits.motor_torque_Nm, {}",
                              options.peak_torque_Nm, input.robot.limits.motor_torque_Nm),
                  "press with less torque");
  const calibrate::PressProgram program{.peak_torque_Nm = options.peak_torque_Nm,
                                        .motor_count = input.robot.robot.motor_count};
  calibrate::Step step;
  step.prompt =
      "clamp the body on its rail with the foot standing on the load cell, leg half bent; hands off";
  step.during = fmt::format("THE MOTORS PRESS with up to {} N m each for {:.0f} s; the e-stop ends it",
                            options.peak_torque_Nm, program.duration_s());
  step.fixture.clamped = true;
  step.fixture.leg_angle_rad = Leg(input.robot.robot).angle_at_length(input.robot.arming.zero_pose_length_m);
  step.seconds = program.duration_s();
  step.torque_Nm = [program](double time_s) { return program.torque_Nm(time_s); };
  return std::vector(static_cast<std::size_t>(options.repeats), step);
}

// Half-width of the 95 % interval of the load cell's scale, relative to the scale, from its calibration; 0:
// never calibrated.
double load_cell_ci95_relative(const LinuxBoardConfig& board) {
  if (!board.calibration || !board.calibration->load_cell) return 0.0;
  const auto& record = *board.calibration->load_cell;
  const auto found = std::ranges::find(record.keys, "load_cell.scale_N_per_V");
  if (found == record.keys.end()) return 0.0;
  return record.ci95[static_cast<std::size_t>(found - record.keys.begin())] / board.load_cell.scale_N_per_V;
}

Calibration::Actions set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("--peak-torque-Nm", options->peak_torque_Nm, "of each motor")
      .in_range(0.1, 50.0)
      .show_default();
  arguments
      .add_option("--repeats", options->repeats, "presses: left motor, right motor, both, up and down each")
      .in_range(3, 50)
      .show_default();
  return {.steps = [options](const CalibrationInput& input) { return steps(*options, input); },
          .fit =
              [](const auto& recordings, const auto& input) {
                return calibrate_torque_constant(
                    recordings, input.board, Leg(input.robot.robot),
                    {.load_cell_ci95_relative = load_cell_ci95_relative(input.board)});
              }};
}

const CalibrationRegistration kTorqueConstant(
    {"torque-constant", "torque constant of each motor, pressing slowly on the calibrated load cell",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
