#include "tools/trial/series_ground.hpp"

#include <fmt/format.h>

#include <array>
#include <vector>

#include "firmware/hop_model.hpp"
#include "tools/trial/replay.hpp"

namespace sandhopper {
namespace {

// Drop heights that an operator can set with a ruler, up to the largest drop that the robot is designed for.
constexpr std::array kDrops_m{0.005, 0.010, 0.020, 0.030, 0.040, 0.050, 0.060, 0.070, 0.080, 0.090};

}  // namespace

SeriesGround::SeriesGround(const RobotConfig& robot)
    : robot_(hop_model_of(cycle_config(robot))),
      leg_stiffness_N_per_m_(robot.controller.compression_stiffness_N_per_m),
      solver_(robot.stiffness) {}

void SeriesGround::add(const std::filesystem::path& log) {
  replay_log(log, {}, [this](const StrideSums& sums) {
    const auto stride = sums.summary.stride;
    solver_.add(sums.profile, stride == 1 && known_ ? ProfileSolver::kFreshGround : stride);
    known_ = true;
  });
}

std::optional<NextStride> SeriesGround::next() const {
  if (!known_) return std::nullopt;
  std::vector<StrideSetup> setups;
  for (const double drop_m : kDrops_m) setups.push_back({drop_m, leg_stiffness_N_per_m_});
  return next_stride(solver_, robot_, setups);
}

std::string to_text(const NextStride& next) {
  return fmt::format(
      "tells most about the ground next: a drop from {:.0f} mm, to about {:.0f} mm of depth; the widest 95 % "
      "band of "
      "the force there is {:.1f} N now and expected to be {:.1f} N then",
      1e3 * next.setup.drop_height_m, 1e3 * next.reach_m, next.widest_now_N, next.widest_expected_N);
}

}  // namespace sandhopper
