#include "tools/campaign/surface_onset.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "read_campaign.hpp"

// Recordings that begin when the foot is in the bed already, and those that begin above it.
namespace sandhopper {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A press of 300 rows from a depth of `from_m` on. The bed begins to bear at `surface_m`.
std::string press(double from_m, double surface_m, double step_m) {
  std::string csv = "t_s,foot_z_m,force_N\n";
  for (int i = 0; i < 300; ++i) {
    const double depth_m = from_m + step_m * i;
    csv += fmt::format("{:.3f},{:.6f},{:.4f}\n", 0.005 * i, -depth_m,
                       2000.0 * std::max(0.0, depth_m - surface_m) + 0.1 * std::sin(7.0 * i * i));
  }
  return read_campaign("plant = \"intruder\"\n[every_trial]\nkind = \"intrusion\"\nplate_diameter_m = 0.08",
                       csv)
      .text;
}

TEST(SurfaceOnset, AFootThatIsInTheBedAlreadyHasNoSurface) {
  for (const double step_m : {2e-5, 5e-5, 1e-4, 2.5e-4})
    for (const double from_m : {0.005, 0.0174, 0.05}) EXPECT_THAT(press(from_m, 0.0, step_m), IsEmpty());
}

TEST(SurfaceOnset, AFootThatBeginsInAirShowsIt) {
  EXPECT_THAT(press(-0.005, 0.0, 1e-4), IsEmpty());
  EXPECT_THAT(press(0.005, 0.010, 1e-4), HasSubstr("the force begins at a depth of 10 mm"));
  EXPECT_THAT(press(0.005, 0.025, 1e-4),
              HasSubstr("0.0252 m below the surface before the bed bears anything"));
}

}  // namespace
}  // namespace sandhopper
