#include <fmt/format.h>

#include <array>

#include "tools/calibrate/imu.hpp"
#include "tools/cli/calibration.hpp"
#include "tools/cli/failure.hpp"

namespace sandhopper::cli {
namespace {

struct Options {
  std::string imu = "body";
  int poses = 12;
  double gravity_mps2 = kGravity_mps2;
  double seconds = 3.0;
};

struct Face {
  const char* up;
  std::array<double, 3> direction;
};
constexpr std::array<Face, 6> kFaces{{{"+z", {0, 0, 1}},
                                      {"-z", {0, 0, -1}},
                                      {"+x", {1, 0, 0}},
                                      {"-x", {-1, 0, 0}},
                                      {"+y", {0, 1, 0}},
                                      {"-y", {0, -1, 0}}}};

std::vector<calibrate::Step> steps(const Options& options) {
  std::vector<calibrate::Step> out;
  for (int i = 0; i < options.poses; ++i) {
    const auto& face = kFaces[static_cast<std::size_t>(i) % kFaces.size()];
    calibrate::Step step;
    step.prompt = fmt::format("lay the {} down with its {} axis up, to ten degrees or so, on something firm",
                              options.imu, face.up);
    step.fixture.body_up = step.fixture.foot_up = face.direction;
    step.seconds = options.seconds;
    out.push_back(step);
  }
  return out;
}

calibrate::Outcome fit(const std::vector<calibrate::Recording>& recordings, const CalibrationInput& input,
                       const Options& options) {
  const bool body = options.imu == "body";
  const calibrate::ImuChoice which{body ? "imu_body" : "imu_foot",
                                   body ? &calibrate::Recording::imu_body : &calibrate::Recording::imu_foot};
  return calibrate_imu(recordings, which, body ? input.board.imu_body : input.board.imu_foot,
                       {.gravity_mps2 = options.gravity_mps2});
}

Calibration::Actions set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  arguments.add_option("--imu", options->imu, "which one").one_of({"body", "foot"}).show_default();
  arguments.add_option("--poses", options->poses, "how many still poses; the six faces first, in turn")
      .in_range(9, 200)
      .show_default();
  add_gravity(arguments, options->gravity_mps2, "of this place; the firmware computes with 9.81");
  add_seconds(arguments, options->seconds);
  return {.steps = [options](const CalibrationInput&) { return steps(*options); },
          .fit = [options](const auto& recordings,
                           const auto& input) { return fit(recordings, input, *options); }};
}

const CalibrationRegistration kImu({"imu",
                                    "scale and bias of an accelerometer, bias of its gyro, from still poses",
                                    set_up});

}  // namespace
}  // namespace sandhopper::cli
