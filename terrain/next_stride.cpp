#include "terrain/next_stride.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

constexpr double kStep_s = 1e-3;  // the cycle's
constexpr double kGravity = 9.80665;
constexpr int kLongest_steps = 800;
constexpr double kPitch_m = 0.0025;
constexpr std::uint32_t kFreshGround = 0;  // for ProfileSolver::add

struct Hop {
  double depth_m = 0.0, foot_mps = 0.0, body_m = 0.0, body_mps = 0.0;  // down positive; body from its height at contact
  bool extends = false;

  double leg_m(double free_m) const { return free_m - (body_m - depth_m); }
  double leg_mps() const { return foot_mps - body_mps; }
};

}  // namespace

double widest_band(const ProfileSolver& solver, const DepthRange& range) noexcept {
  double widest = 0.0;
  for (double z = range.from_m; z <= range.to_m + 1e-9; z += kPitch_m) {
    const auto force = solver.force_N(z);
    if (force.value > 0.0) widest = std::max(widest, (force.high() - force.low()) / force.value);
  }
  return widest;
}

ProfileSums predicted_stride(const ProfileSolver& solver, const HopModel& robot, const StrideSetup& setup) {
  const auto& config = solver.config();
  const Bed cone(BedParameters{}, robot.foot_radius_m);
  ProfileRegression regression(config, robot.foot_radius_m, robot.foot_mass_kg);
  const double c = std::max(solver.profile().stride > 0 ? solver.profile().added_mass_factor : 1.0, 0.0);
  const double speed = std::sqrt(2.0 * kGravity * std::max(setup.drop_height_m, 0.0));
  Hop hop{.foot_mps = speed, .body_mps = speed};
  double deepest_m = 0.0;
  for (int i = 1; i < kLongest_steps; ++i) {
    const double leg_m = hop.leg_m(robot.compression_length_m);
    hop.extends = hop.extends || (i > 10 && hop.leg_mps() >= 0.0);
    const double free_m = hop.extends ? robot.extension_length_m : robot.compression_length_m;
    const double stiffness = hop.extends ? robot.extension_stiffness_N_per_m : setup.leg_stiffness_N_per_m;
    const double leg_N = std::clamp(stiffness * (free_m - leg_m), 0.0, robot.greatest_leg_force_N);
    if (hop.extends && leg_m >= free_m) break;
    const auto curve = solver.force_N(hop.depth_m);
    if (!std::isfinite(curve.value)) break;
    const double virgin_N = std::max(curve.value, 0.0);
    const double drag_N = c * cone.added_mass_gradient_kg_per_m(hop.depth_m) * hop.foot_mps * hop.foot_mps;
    const double push_N = robot.foot_mass_kg * kGravity + leg_N;
    const double added_kg = c * cone.added_mass_kg(hop.depth_m);
    double accel = (push_N - virgin_N - drag_N) / (robot.foot_mass_kg + added_kg);
    if (hop.foot_mps <= 0.0 && accel < 0.0) accel = 0.0;  // it stands
    if (hop.foot_mps > config.min_speed_mps && hop.depth_m > deepest_m)
      regression.add({hop.depth_m, hop.foot_mps, accel, virgin_N + drag_N + added_kg * accel, hop.leg_mps(),
                      i * kStep_s, kStep_s},
                     leg_N);
    deepest_m = std::max(deepest_m, hop.depth_m);
    hop.foot_mps = std::max(0.0, hop.foot_mps + accel * kStep_s);
    hop.body_mps += (kGravity - leg_N / robot.body_mass_kg) * kStep_s;
    hop.depth_m += hop.foot_mps * kStep_s;
    hop.body_m += hop.body_mps * kStep_s;
  }
  return regression.sums();
}

NextStride next_stride(const ProfileSolver& solver, const HopModel& robot, std::span<const StrideSetup> candidates,
                       const DepthRange& range) {
  NextStride best;
  best.widest_now = widest_band(solver, range);
  best.widest_expected = std::numeric_limits<double>::infinity();
  bool best_too_deep = true;
  for (const auto& setup : candidates) {
    const auto sums = predicted_stride(solver, robot, setup);
    const bool too_deep = sums.depth_max_m > range.to_m + kProfileCell_m;
    ProfileSolver after = solver;
    after.add(sums, kFreshGround);
    const double widest = widest_band(after, range);
    const bool better = too_deep != best_too_deep ? best_too_deep : widest < best.widest_expected;
    if (!better) continue;
    best_too_deep = too_deep;
    best.setup = setup;
    best.reach_m = sums.depth_max_m;
    best.widest_expected = widest;
  }
  return best;
}

}  // namespace sandhopper
