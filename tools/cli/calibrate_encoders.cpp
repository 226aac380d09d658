#include <fmt/format.h>

#include "tools/calibrate/encoders.hpp"
#include "tools/cli/calibration.hpp"
#include "tools/cli/failure.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  double length_m = 0.0;  // 0: use arming.zero_pose_length_m
  double length_accuracy_m = 0.0005;
  int repeats = 3;
  double seconds = 2.0;
};

double known_length_m(const Options& options, const CalibrationInput& input) {
  return options.length_m > 0.0 ? options.length_m : input.robot.arming.zero_pose_length_m;
}

std::vector<calibrate::Step> steps(const Options& options, const CalibrationInput& input) {
  const double length_m = known_length_m(options, input);
  const Leg leg(input.robot.robot);
  const double angle_rad = leg.angle_at_length(length_m);
  std::vector<calibrate::Step> out;
  for (int i = 0; i < options.repeats; ++i) {
    calibrate::Step known, shortened;
    known.prompt = fmt::format(
        "bring the leg to {:.1f} mm from hip axis to toe joint, against its stop or a gauge", 1e3 * length_m);
    known.fixture.leg_angle_rad = angle_rad;
    shortened.prompt = "shorten the leg by hand by 3 cm or more, and hold it there";
    shortened.fixture.leg_angle_rad = angle_rad + 0.4;
    known.seconds = shortened.seconds = options.seconds;
    out.push_back(known);
    out.push_back(shortened);
  }
  for (int i = 0; i < options.repeats; ++i) {
    calibrate::Step moved;
    moved.prompt = "move the leg by hand from long to short and back, about once a second";
    moved.during = "go on until the recording ends";
    moved.fixture.leg_angle_rad = angle_rad;
    moved.fixture.leg_swing_rad = 0.6;
    moved.seconds = options.seconds;
    out.push_back(moved);
  }
  return out;
}

calibrate::Outcome fit(const std::vector<calibrate::Recording>& recordings, const CalibrationInput& input,
                       const Options& options) {
  calibrate::EncoderRecordings grouped;
  const auto poses = 2 * static_cast<std::size_t>(options.repeats);
  for (std::size_t i = 0; i < poses; i += 2) grouped.pairs.push_back({recordings[i], recordings[i + 1]});
  grouped.moved.assign(recordings.begin() + static_cast<std::ptrdiff_t>(poses), recordings.end());
  return calibrate_encoders(
      grouped, input.robot.motor, Leg(input.robot.robot),
      {.known_length_m = known_length_m(options, input), .length_accuracy_m = options.length_accuracy_m});
}

Calibration::Actions set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments
      .add_option("--length-m", options->length_m,
                  "hip axis to toe joint in the known pose; default arming.zero_pose_length_m")
      .in_range(0.05, 2.0);
  arguments.add_option("--length-accuracy-m", options->length_accuracy_m, "how well that is known (95 %)")
      .in_range(0.0, 0.02)
      .show_default();
  arguments
      .add_option(
          "--repeats", options->repeats,
          "pairs of recordings: known pose, then leg shortened by hand; and after them as many with the "
          "leg moved to and fro")
      .in_range(3, 50)
      .show_default();
  add_seconds(arguments, options->seconds);
  return {.steps = [options](const CalibrationInput& input) { return steps(*options, input); },
          .fit = [options](const auto& recordings,
                           const auto& input) { return fit(recordings, input, *options); }};
}

const CalibrationRegistration kEncoders(
    {"encoders",
     "zero and sign of both motors' encoders, in a known pose of the leg; "
     "whether the drives' velocity range is right",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
