#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "terrain/strength_profile.hpp"
#include "tests/unit/profile_pushes.hpp"

// The profile of several places, and what strides of one place cannot tell.
namespace sandhopper {
namespace {

struct PlacesScore {
  double inside = 0.0;          // share of the depths whose force the band holds
  double width_relative = 0.0;  // to the band of one place, at 30 mm
};

// Places of a ground prepared alike have a curve in common. Each has its own fluctuation of 2 % over 2 mm,
// and its own depth errors.
PlacesScore score_of_places(const Curve& common_N) {
  constexpr unsigned kSessions = 30, kPlaces = 6;
  const double cone_kg_per_m = Bed(BedParameters{}, kRadius_m).added_mass_gradient_kg_per_m(0.0);
  std::mt19937 engine(5);
  std::normal_distribution<double> normal;
  double inside = 0.0, all = 0.0, width = 0.0, width_of_one = 0.0;
  for (unsigned session = 0; session < kSessions; ++session) {
    ProfileSolver solver(without_steady_drag());
    for (unsigned place = 0; place < kPlaces; ++place) {
      std::array<double, 24> knots;
      for (double& knot : knots) knot = normal(engine);
      const auto curve = [&](double z) {
        return common_N(z) *
               (1.0 + 0.02 * knots[std::min<std::size_t>(static_cast<std::size_t>(z / 0.002), 23)]);
      };
      Push push{
          .speed_mps = 0.6 + 0.1 * place, .seed = kPlaces * session + place, .lasts = 1.8, .contact = true};
      const auto contact = solver.contact_depth(push.speed_mps, cone_kg_per_m);
      push.too_deep_m = -contact.mean_m + std::sqrt(contact.variance_m2) * normal(engine);
      solver.add(sums_of(curve, push), place == 0 ? 1 : ProfileSolver::kFreshGround);
      if (place == 0) width_of_one += solver.force_N(0.030).sd;
    }
    width += solver.force_N(0.030).sd;
    for (double z = 0.005; z < 0.036; z += 0.001) {
      const auto force = solver.force_N(z);
      inside += force.low() < common_N(z) && common_N(z) < force.high();
      all += 1.0;
    }
  }
  return {inside / all, width / width_of_one};
}

TEST(StrengthProfile, BandOfSeveralPlacesHoldsTheirCommonCurve) {
  const auto line = score_of_places(line_N), hardens = score_of_places(power_N);
  EXPECT_GE(line.inside, 0.93);
  EXPECT_GE(hardens.inside, 0.9);
  for (const auto& score : {line, hardens}) EXPECT_LT(score.width_relative, 0.7);
}

// The depth error of a stride, its joint friction and the strength of its place belong to that stride. They
// are no curve that varies within a cell. With a depth error of two standard deviations, taken for such a
// curve, the band of two places was twice as wide.
TEST(StrengthProfile, AStridesOwnErrorIsNoMisfitOfTheCells) {
  constexpr double kDepth_m = 0.030;
  const auto sd_with = [&](double too_deep_m, double stronger) {
    ProfileSolver solver(without_steady_drag());
    const auto curve = [&](double z) { return (1.0 + stronger) * line_N(z); };
    solver.add(sums_of(line_N, {.seed = 1, .contact = true}), 1);
    solver.add(sums_of(curve, {.too_deep_m = too_deep_m, .seed = 2, .contact = true}),
               ProfileSolver::kFreshGround);
    return solver.force_N(kDepth_m).sd;
  };
  const double alike = sd_with(0.0, 0.0);
  for (const double sd : {sd_with(0.001, 0.0), sd_with(0.0, 0.06)}) {
    EXPECT_GT(sd, 0.7 * alike);
    EXPECT_LT(sd, 1.4 * alike);
  }
}

// Places of different strength: the band of the common curve counts how different they are, and the strengths
// are not taken for a drag or an error of the force scale.
TEST(StrengthProfile, TheStatedSpreadBetweenPlacesIsInTheBand) {
  constexpr double kDepth_m = 0.030;
  struct Found {
    double inside = 0.0, sd_N = 0.0;
  };
  const auto found_with = [&](double spread) {
    constexpr unsigned kSessions = 20, kPlaces = 8;
    std::mt19937 engine(7);
    std::normal_distribution<double> normal;
    Found found;
    for (unsigned session = 0; session < kSessions; ++session) {
      StiffnessConfig config;
      config.profile = ProfileConfig{.place_strength_sd_relative = std::max(0.03, spread)};
      ProfileSolver solver(config);
      double mean = 0.0;
      for (unsigned place = 0; place < kPlaces; ++place) {
        const double strength = 1.0 + spread * normal(engine);
        mean += strength / kPlaces;
        const auto curve = [&](double z) { return strength * line_N(z); };
        solver.add(sums_of(curve, {.speed_mps = 0.4 + 0.1 * place,
                                   .to_m = 0.020 + 0.004 * place,
                                   .seed = kPlaces * session + place,
                                   .contact = true}),
                   place == 0 ? 1 : ProfileSolver::kFreshGround);
      }
      const auto force = solver.force_N(kDepth_m);
      const double true_N = mean * line_N(kDepth_m);
      found.inside += (force.low() < true_N && true_N < force.high()) / static_cast<double>(kSessions);
      found.sd_N += force.sd / kSessions;
    }
    return found;
  };
  const Found alike = found_with(0.0), different = found_with(0.15);
  EXPECT_GE(alike.inside, 0.85);
  EXPECT_GE(different.inside, 0.85);
  EXPECT_GT(different.sd_N, 1.3 * alike.sd_N);
  EXPECT_LT(different.sd_N, 5.0 * alike.sd_N);
}

// The curve of one place is that of the place, however different others may be.
TEST(StrengthProfile, TheBandOfOnePlaceDoesNotDependOnTheSpreadBetweenPlaces) {
  const auto sd_with = [](double spread, unsigned places) {
    StiffnessConfig config;
    config.profile = ProfileConfig{.place_strength_sd_relative = spread};
    ProfileSolver solver(config);
    for (unsigned place = 0; place < places; ++place)
      solver.add(sums_of(line_N, {.to_m = 0.045 - 0.015 * place, .seed = place + 1}),
                 place == 0 ? 1 : ProfileSolver::kFreshGround);
    return solver.force_N(0.040).sd;
  };
  EXPECT_EQ(sd_with(0.3, 1), sd_with(0.001, 1));
  EXPECT_GT(sd_with(0.3, 2), 1.1 * sd_with(0.001, 2));
}

// A drag that does not fade with depth has the form of a curve in a stride. The band of a fast stride counts
// it, that of a slow one hardly, and that of many strides of one set-up counts that it is the same in all.
TEST(StrengthProfile, DragThatStaysAtDepthIsNoStrength) {
  constexpr double kFast_mps = 1.4, kSlow_mps = 0.3;
  constexpr double kDrag = 0.5;
  const auto solved_with = [](double prior_sd, double speed_mps, unsigned places) {
    StiffnessConfig config;
    config.profile = ProfileConfig{.steady_drag_sd = prior_sd};
    ProfileSolver solver(config);
    for (unsigned place = 0; place < places; ++place)
      solver.add(sums_of(line_N, {.speed_mps = speed_mps, .steady_drag = kDrag, .seed = place + 1}),
                 place == 0 ? 1 : ProfileSolver::kFreshGround);
    return solver;
  };
  const auto held = [](const ProfileSolver& solver) {
    int inside = 0, all = 0;
    for (double z = 0.005; z < 0.040; z += 0.001, ++all) {
      const auto force = solver.force_N(z);
      inside += force.low() < line_N(z) && line_N(z) < force.high();
    }
    return static_cast<double>(inside) / all;
  };
  const double sd = ProfileConfig{}.steady_drag_sd;
  for (const unsigned places : {1U, 10U}) {
    EXPECT_GE(held(solved_with(sd, kFast_mps, places)), 0.9) << places;
    EXPECT_LT(held(solved_with(1e-6, kFast_mps, places)), 0.8) << places;
  }
  const auto widening = [&](double speed_mps) {
    constexpr double kDepth_m = 0.020;
    return solved_with(sd, speed_mps, 1).force_N(kDepth_m).sd /
           solved_with(1e-6, speed_mps, 1).force_N(kDepth_m).sd;
  };
  EXPECT_GT(widening(kFast_mps), 1.3);
  EXPECT_LT(widening(kFast_mps), 3.5);
  EXPECT_LT(widening(kSlow_mps), 1.1);
}

// The drag is the same in all strides and the curve, too, so a slow stride beside a fast one tells them
// apart.
TEST(StrengthProfile, StridesOfSeveralSpeedsTellTheDragFromTheStrength) {
  constexpr double kDepth_m = 0.020, kLargest = 1.0;  // drag that is reported
  const auto solved_at = [](const std::vector<double>& speeds_mps) {
    ProfileSolver solver{StiffnessConfig{}};
    unsigned place = 0;
    for (const double speed_mps : speeds_mps) {
      solver.add(sums_of(line_N, {.speed_mps = speed_mps, .steady_drag = kLargest, .seed = place + 1}),
                 place == 0 ? 1 : ProfileSolver::kFreshGround);
      ++place;
    }
    return solver.force_N(kDepth_m);
  };
  const auto fast = solved_at({1.4, 1.4, 1.4, 1.4, 1.4}), several = solved_at({1.4, 0.3, 0.6, 0.9, 1.2});
  EXPECT_LT(several.sd, 0.7 * fast.sd);
  EXPECT_LT(std::abs(several.value - line_N(kDepth_m)), 1.96 * several.sd);
  EXPECT_LT(std::abs(several.value - line_N(kDepth_m)), 0.5 * std::abs(fast.value - line_N(kDepth_m)));
}

// The depths have no error here, but the model expects one. This mismatch is the same in all strides and must
// not grow with their number.
TEST(StrengthProfile, AnErrorThatStridesOfOneSetupShareDoesNotGrow) {
  ProfileSolver solver{StiffnessConfig{}};
  for (unsigned place = 0; place < 10; ++place)
    solver.add(sums_of(line_N, {.speed_mps = 1.4, .seed = place + 1}),
               place == 0 ? 1 : ProfileSolver::kFreshGround);
  for (double z = 0.005; z < 0.040; z += 0.005) {
    const auto force = solver.force_N(z);
    EXPECT_LT(std::abs(force.value - line_N(z)), 1.96 * force.sd) << z;
  }
}

// However many places there are, the band stays as wide as the error that they share. No stride narrows this
// part, so the planner's band leaves it out.
TEST(StrengthProfile, TheErrorThatAllPlacesShareDoesNotAverageOut) {
  constexpr double kDepth_m = 0.030, kTangent_N_per_m = 2000.0;
  constexpr std::uint32_t kPlaces = 40;
  const auto shared_N = ProfileConfig{}.shared_surface_sd_m * kTangent_N_per_m;
  StiffnessConfig config = without_steady_drag();
  config.joint.force_scale_relative = 1e-4;  // an error of the torque constant does not average out either
  ProfileSolver solver(config);
  for (std::uint32_t place = 0; place < kPlaces; ++place)
    solver.add(sums_of([](double z) { return kTangent_N_per_m * z; },
                       {.speed_mps = 0.4 + 0.02 * place, .seed = place + 1, .contact = true}),
               place == 0 ? 1 : ProfileSolver::kFreshGround);
  EXPECT_GT(solver.force_N(kDepth_m).sd, 0.7 * shared_N);
  EXPECT_LT(solver.force_N(kDepth_m, ProfileSolver::Band::narrowable).sd, 0.7 * solver.force_N(kDepth_m).sd);
}

// A place whose curve fits a cell does not cancel the misfit of another.
TEST(StrengthProfile, MisfitOfACellIsPooledOverPlaces) {
  const auto jagged_N = [](double z) { return line_N(z) + (z > 0.0200 && z < 0.02125 ? 20.0 : 0.0); };
  const auto sd_of = [&](const Curve& first) {
    auto solver = solved(first, {});
    solver.add(sums_of(line_N, {.seed = 2}), ProfileSolver::kFreshGround);
    return solver.force_N(0.02125).sd;
  };
  EXPECT_GT(sd_of(jagged_N), 1.5 * sd_of(line_N));
}

}  // namespace
}  // namespace sandhopper
