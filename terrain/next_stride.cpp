#include "terrain/next_stride.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sandhopper {
namespace {

constexpr double kStep_s = 1e-3;  // time step, equal to the cycle's
constexpr int kLongest_steps = 800;
constexpr int kFirst_steps = 10;  // least number of steps before the leg extends
constexpr double kPitch_m = 0.0025;
// Gauss-Hermite quadrature of three points for a standard normal variable.
constexpr std::array<double, 3> kDeviations{-1.7320508, 0.0, 1.7320508};
constexpr std::array<double, 3> kWeights{1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};

struct Hop {
  // Downward positive. body_m counts from the body's height at contact.
  double depth_m = 0.0, foot_mps = 0.0, body_m = 0.0, body_mps = 0.0;
  bool extends = false;

  double leg_m(double free_m) const { return free_m - (body_m - depth_m); }
  double leg_mps() const { return foot_mps - body_mps; }
};

}  // namespace

double widest_band_N(const ProfileSolver& solver, const DepthRange& range,
                     ProfileSolver::Band band) noexcept {
  double widest = 0.0;
  for (double z = range.from_m; z <= range.to_m + 1e-9; z += kPitch_m) {
    const auto force = solver.force_N(z, band);
    widest = std::max(widest, force.high() - force.low());
  }
  return widest;
}

ProfileSums predicted_stride(const ProfileSolver& solver, const HopModel& robot, const StrideSetup& setup,
                             double deviations) {
  const auto& config = solver.config();
  const Bed cone(BedParameters{}, robot.foot_radius_m);
  ProfileRegression regression(config, robot.foot_radius_m, robot.foot_mass_kg);
  const double c = std::max(solver.profile().stride > 0 ? solver.profile().added_mass_factor : 1.0, 0.0);
  const double falling_kg = robot.body_mass_kg + robot.foot_mass_kg;
  const double fall_mps2 = robot.gravity_mps2 - robot.rail_friction_N / falling_kg;
  const double speed = std::sqrt(2.0 * fall_mps2 * std::max(setup.drop_height_m, 0.0));
  regression.on_contact(speed);
  const double contact_m = solver.contact_depth(speed, regression.sums().contact_added_mass_kg_per_m).mean_m;
  Hop hop{.foot_mps = speed, .body_mps = speed};
  double deepest_m = 0.0;
  bool lifted_off = false;
  for (int i = 1; i < kLongest_steps; ++i) {
    const double leg_m = hop.leg_m(robot.compression_length_m);
    hop.extends = hop.extends || (i > kFirst_steps && hop.leg_mps() >= 0.0);
    const double free_m = hop.extends ? robot.extension_length_m : robot.compression_length_m;
    const double stiffness = hop.extends ? robot.extension_stiffness_N_per_m : setup.leg_stiffness_N_per_m;
    lifted_off = hop.extends && leg_m >= free_m;
    if (lifted_off) break;
    const double leg_N = std::clamp(stiffness * (free_m - leg_m), 0.0, robot.greatest_leg_force_N(leg_m));
    const auto curve = solver.force_N(std::min(hop.depth_m, kProfileDepth_m));
    const double virgin_N = std::max(curve.value + deviations * curve.sd, 0.0);
    const double drag_N = c * cone.added_mass_gradient_kg_per_m(hop.depth_m) * hop.foot_mps * hop.foot_mps;
    const double push_N = robot.foot_mass_kg * robot.gravity_mps2 + leg_N;
    const double added_kg = c * cone.added_mass_kg(hop.depth_m);
    double accel = (push_N - virgin_N - drag_N) / (robot.foot_mass_kg + added_kg);
    if (hop.foot_mps <= 0.0 && accel < 0.0) accel = 0.0;  // the foot rests
    if (hop.foot_mps > config.min_speed_mps && hop.depth_m > deepest_m)
      // A sample has the mean's values, so that the predicted narrowing of the band does not depend on the
      // deviation.
      regression.add(
          {hop.depth_m - contact_m, hop.foot_mps, accel,
           std::max(curve.value, 0.0) + drag_N + added_kg * accel, hop.leg_mps(), i * kStep_s, kStep_s},
          leg_N);
    deepest_m = std::max(deepest_m, hop.depth_m);
    hop.foot_mps = std::max(0.0, hop.foot_mps + accel * kStep_s);
    const double friction_N = hop.body_mps > 0.0 ? robot.rail_friction_N : -robot.rail_friction_N;
    hop.body_mps += (robot.gravity_mps2 - (leg_N + friction_N) / robot.body_mass_kg) * kStep_s;
    hop.depth_m += hop.foot_mps * kStep_s;
    hop.body_m += hop.body_mps * kStep_s;
  }
  return lifted_off ? regression.sums() : ProfileSums{};
}

NextStride next_stride(const ProfileSolver& solver, const HopModel& robot,
                       std::span<const StrideSetup> candidates, const DepthRange& interest) {
  double deepest_m = 0.0;
  for (const auto& setup : candidates)
    deepest_m = std::max(deepest_m, predicted_stride(solver, robot, setup).depth_max_m);
  const DepthRange range{interest.from_m, std::clamp(deepest_m, interest.from_m, interest.to_m)};
  constexpr auto kBand = ProfileSolver::Band::narrowable;
  NextStride best;
  best.range = range;
  best.widest_now_N = widest_band_N(solver, range, kBand);
  best.widest_expected_N = std::numeric_limits<double>::infinity();
  for (const auto& setup : candidates) {
    double expected = 0.0, reach_m = 0.0;
    for (std::size_t i = 0; i < kDeviations.size(); ++i) {
      const auto sums = predicted_stride(solver, robot, setup, kDeviations[i]);
      ProfileSolver after = solver;
      after.add(sums, ProfileSolver::kFreshGround);
      expected += kWeights[i] * widest_band_N(after, range, kBand);
      reach_m += kWeights[i] * sums.depth_max_m;
    }
    if (!(expected < best.widest_expected_N)) continue;
    best.setup = setup;
    best.reach_m = reach_m;
    best.widest_expected_N = expected;
  }
  return best;
}

}  // namespace sandhopper
