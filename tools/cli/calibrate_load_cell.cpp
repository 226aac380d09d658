#include <fmt/format.h>

#include "tools/calibrate/load_cell.hpp"
#include "tools/cli/calibration.hpp"
#include "tools/cli/failure.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::vector<double> weights_kg{0.0, 1.0, 2.0, 5.0, 2.0, 1.0, 0.0};
  double gravity_mps2 = kGravity_mps2;
  double seconds = 3.0;
};

std::vector<calibrate::Step> steps(const Options& options) {
  std::vector<calibrate::Step> out;
  for (const double mass_kg : options.weights_kg) {
    calibrate::Step step;
    step.prompt = mass_kg == 0.0
                      ? "take every weight off the load cell"
                      : fmt::format("put {} kg on the load cell, along its axis, standing still", mass_kg);
    step.fixture.load_N = mass_kg * options.gravity_mps2;
    step.seconds = options.seconds;
    out.push_back(step);
  }
  return out;
}

calibrate::Outcome fit(const std::vector<calibrate::Recording>& recordings, const CalibrationInput& input,
                       const Options& options) {
  std::vector<calibrate::WeighedPoint> points;
  for (std::size_t i = 0; i < recordings.size(); ++i)
    points.push_back({options.weights_kg[i], recordings[i]});
  return calibrate_load_cell(points, input.board.load_cell, {.gravity_mps2 = options.gravity_mps2});
}

Calibration::Actions set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments
      .add_option("--weights-kg", options->weights_kg,
                  "weights in the order of the recordings; up and down again shows drift")
      .separated_by(',')
      .in_range(0.0, 50.0)
      .show_default();
  add_gravity(arguments, options->gravity_mps2, "where the weights stand");
  add_seconds(arguments, options->seconds);
  return {.steps = [options](const CalibrationInput&) { return steps(*options); },
          .fit = [options](const auto& recordings,
                           const auto& input) { return fit(recordings, input, *options); }};
}

const CalibrationRegistration kLoadCell({"load-cell",
                                         "gain, zero and sign of the load cell, with known weights", set_up});

}  // namespace
}  // namespace sandhopper::cli
