#include <fmt/format.h>

#include "tools/calibrate/tof.hpp"
#include "tools/cli/calibration.hpp"
#include "tools/cli/failure.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::vector<double> heights_m{0.40, 0.45, 0.50, 0.45, 0.40};
  double seconds = 3.0;
};

std::vector<calibrate::Step> steps(const Options& options) {
  std::vector<calibrate::Step> out;
  for (const double height_m : options.heights_m) {
    calibrate::Step step;
    step.prompt =
        fmt::format("hold the body with its hip axis {:.1f} mm over a flat, firm surface", 1e3 * height_m);
    step.fixture.body_height_m = height_m;
    step.seconds = options.seconds;
    out.push_back(step);
  }
  return out;
}

calibrate::Outcome fit(const std::vector<calibrate::Recording>& recordings, const CalibrationInput& input,
                       const Options& options) {
  std::vector<calibrate::HeightPoint> points;
  for (std::size_t i = 0; i < recordings.size(); ++i) points.push_back({options.heights_m[i], recordings[i]});
  return calibrate_tof(points, input.board.tof);
}

Calibration::Actions set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("--heights-m", options->heights_m, "of the hip axis, in the order of the recordings")
      .separated_by(',')
      .in_range(0.02, 10.0)
      .show_default();
  add_seconds(arguments, options->seconds);
  return {.steps = [options](const CalibrationInput&) { return steps(*options); },
          .fit = [options](const auto& recordings,
                           const auto& input) { return fit(recordings, input, *options); }};
}

const CalibrationRegistration kTof({"tof", "offset of the time-of-flight sensor, at known heights", set_up});

}  // namespace
}  // namespace sandhopper::cli
