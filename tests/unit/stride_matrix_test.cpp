#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "tools/experiment/nominal_stride.hpp"

// First stride of the default robot for five touchdown speeds and three compression stiffnesses, compared
// with printed figures of an independent program. Times count from physical contact. Forces and accelerations
// are means over a millisecond, as that program logged them; the force has steps within one, because the cone
// of grains separates as the foot stops.
namespace sandhopper {
namespace {

struct Figures {
  double compression_ms, extension_ms;  // from contact to switch, from switch to liftoff
  double early_peak_N, early_peak_ms;   // largest local maximum in the first 60 ms
  double rest_ms;                       // when the foot is slower than 5 % of its touchdown speed
  double foot_speed_at_switch_mps;      // downward
  double peak_force_N, max_depth_mm, liftoff_depth_mm;
  double leg_deflection_mm;                        // relative to the length at contact
  double touchdown_accel_mps2, switch_accel_mps2;  // of the foot: maximum in 60 ms, minimum in 40 ms
};

struct Cell {
  double speed_mps, stiffness_N_per_cm, height_mm;
  Figures expected;
};

constexpr std::array<Cell, 15> kCells{{
    {.2, 2.5, 2.5, {254, 142, 14.8, 45, 45, -.00, 65.9, 42.6, 41.3, 102, 10, -25}},
    {.2, 3.75, 2.5, {214, 149, 14.8, 46, 46, -.00, 56.2, 36.1, 35.0, 68, 9, -16}},
    {.2, 5.0, 2.5, {191, 173, 15.3, 48, 48, .00, 50.4, 32.0, 31.0, 50, 9, -15}},
    {.45, 2.5, 12.5, {226, 142, 20.2, 40, 39, .00, 63.7, 41.3, 39.9, 111, 16, -21}},
    {.45, 3.75, 12.5, {189, 145, 20.4, 41, 40, -.01, 53.1, 33.5, 32.4, 76, 16, -17}},
    {.45, 5.0, 12.5, {138, 176, 20.7, 42, 41, .25, 57.5, 36.6, 35.4, 57, 15, -9}},
    {.7, 2.5, 30.3, {198, 143, 26.2, 39, 38, .08, 68.8, 44.7, 43.3, 126, 24, -21}},
    {.7, 3.75, 30.3, {149, 159, 26.6, 40, 39, .25, 60.6, 38.9, 37.7, 90, 22, -10}},
    {.7, 5.0, 30.3, {125, 165, 27.0, 41, 40, .32, 60.7, 38.6, 37.3, 71, 21, -9}},
    {1.0, 2.5, 61.8, {184, 134, 33.6, 39, 38, .11, 83.0, 55.8, 54.0, 150, 33, -35}},
    {1.0, 3.75, 61.8, {143, 156, 34.2, 40, 39, .25, 65.4, 41.8, 40.4, 110, 31, -11}},
    {1.0, 5.0, 61.8, {122, 162, 34.8, 41, 40, .31, 61.3, 39.0, 37.7, 89, 29, -4}},
    {1.2, 2.5, 89.0, {186, 120, 38.7, 39, 38, .02, 94.2, 64.0, 62.0, 167, 40, -44}},
    {1.2, 3.75, 89.0, {141, 150, 39.2, 40, 39, .22, 68.9, 44.4, 43.0, 124, 36, -13}},
    {1.2, 5.0, 89.0, {121, 160, 40.1, 41, 40, .30, 63.0, 39.9, 38.6, 101, 34, -2}},
}};

Figures figures_of(const NominalStride& stride) {
  const auto& rows = stride.rows;
  const auto first_row = [&](std::size_t from, auto&& holds) {
    while (from + 1 < rows.size() && !holds(rows[from])) ++from;
    return from;
  };
  const auto change = first_row(0, [](const auto& r) { return r.phase == NominalPhase::extension; });
  const auto liftoff = first_row(change, [](const auto& r) { return r.phase == NominalPhase::flight; });
  const auto contact = first_row(0, [](const auto& r) { return r.truth.foot_z_m <= 0.0; });
  const auto& before = rows[contact - 1].truth;
  const auto& after = rows[contact].truth;
  const double contact_ms =
      static_cast<double>(contact) - after.foot_z_m / (after.foot_z_m - before.foot_z_m);
  const double touchdown_speed = -after.foot_velocity_mps;

  Figures f{};
  f.compression_ms = static_cast<double>(change) - contact_ms;
  f.extension_ms = static_cast<double>(liftoff - change);
  f.foot_speed_at_switch_mps = -rows[change].truth.foot_velocity_mps;
  f.liftoff_depth_mm = -1e3 * rows[liftoff].truth.foot_z_m;
  double shortest_m = 1.0;
  f.switch_accel_mps2 = 1e9;
  for (std::size_t i = contact; i < liftoff + 30; ++i) {
    const auto& truth = rows[i].truth;
    const double force_N = rows[i].mean_force_N;
    const double ms = static_cast<double>(i) - contact_ms;
    const double accel_mps2 = (rows[i + 1].truth.foot_velocity_mps - truth.foot_velocity_mps) / 1e-3;
    if (ms < 60.0 && force_N > f.early_peak_N && force_N >= rows[i - 1].mean_force_N &&
        force_N > rows[i + 1].mean_force_N) {
      f.early_peak_N = force_N;
      f.early_peak_ms = ms + 0.5;
    }
    if (f.rest_ms == 0.0 && -truth.foot_velocity_mps < 0.05 * touchdown_speed) f.rest_ms = ms;
    if (ms < 60.0) f.touchdown_accel_mps2 = std::max(f.touchdown_accel_mps2, accel_mps2);
    if (i >= change && i < change + 40) f.switch_accel_mps2 = std::min(f.switch_accel_mps2, accel_mps2);
    f.peak_force_N = std::max(f.peak_force_N, force_N);
    f.max_depth_mm = 1e3 * truth.max_depth_m;
    shortest_m = std::min(shortest_m, truth.leg_length_m);
  }
  f.leg_deflection_mm = 1e3 * (after.leg_length_m - shortest_m);
  return f;
}

void print(const char* what, const Figures& f) {
  std::printf("%-9s %5.1f %5.1f  %5.2f@%4.1f %5.1f  %5.2f  %6.2f %6.2f %6.2f  %6.1f  %5.1f/%6.1f\n", what,
              f.compression_ms, f.extension_ms, f.early_peak_N, f.early_peak_ms, f.rest_ms,
              f.foot_speed_at_switch_mps, f.peak_force_N, f.max_depth_mm, f.liftoff_depth_mm,
              f.leg_deflection_mm, f.touchdown_accel_mps2, f.switch_accel_mps2);
}

// Tolerance: 1 %, and half a unit of the last printed digit.
void expect_printed(double value, double printed, double digit, const char* what) {
  EXPECT_NEAR(value, printed, 0.01 * std::abs(printed) + 0.5 * digit) << what;
}

TEST(StrideMatrix, AgreesWithinOnePercentAndTwoMilliseconds) {
  std::printf(
      "v    k_c       TD->CE CE->LO early peak  rest  v@CE   F_max  z_max  z_LO   defl   a_TD/a_CE\n");
  for (const auto& cell : kCells) {
    const auto f =
        figures_of(nominal_stride({.release_height_m = 1e-3 * cell.height_mm,
                                   .compression_stiffness_N_per_m = 100.0 * cell.stiffness_N_per_cm}));
    std::printf("%.2f %.2f  ", cell.speed_mps, cell.stiffness_N_per_cm);
    print("printed", cell.expected);
    std::printf("           ");
    print("here", f);
    SCOPED_TRACE(::testing::Message()
                 << "v " << cell.speed_mps << ", k_c " << cell.stiffness_N_per_cm << " N/cm");
    const auto& e = cell.expected;
    EXPECT_NEAR(f.compression_ms, e.compression_ms, 2.0);
    EXPECT_NEAR(f.extension_ms, e.extension_ms, 2.0);
    EXPECT_NEAR(f.early_peak_ms, e.early_peak_ms, 2.0);
    EXPECT_NEAR(f.rest_ms, e.rest_ms, 2.0);
    expect_printed(f.early_peak_N, e.early_peak_N, 0.1, "early peak");
    expect_printed(f.foot_speed_at_switch_mps, e.foot_speed_at_switch_mps, 0.01, "foot speed at the switch");
    expect_printed(f.peak_force_N, e.peak_force_N, 0.1, "peak force");
    expect_printed(f.max_depth_mm, e.max_depth_mm, 0.1, "greatest depth");
    expect_printed(f.liftoff_depth_mm, e.liftoff_depth_mm, 0.1, "depth at liftoff");
    expect_printed(f.leg_deflection_mm, e.leg_deflection_mm, 1.0, "leg deflection");
    expect_printed(f.touchdown_accel_mps2, e.touchdown_accel_mps2, 1.0, "acceleration after touchdown");
    expect_printed(f.switch_accel_mps2, e.switch_accel_mps2, 1.0, "acceleration after the switch");
  }
}

// Liftoff [s after release], peak force [N] and depth [mm] at 1.0 m/s and 375 N/m on other beds.
TEST(StrideMatrix, OtherBedsAgreeToo) {
  struct Variant {
    double stiffness_N_per_m, added_mass_factor, liftoff_s, peak_force_N, max_depth_mm;
  };
  for (const auto& v : {Variant{1000, 1, .426, 66.5, 65.7}, Variant{2500, 1, .414, 62.8, 23.0},
                        Variant{1500, 2, .419, 64.7, 42.2}}) {
    WorldConfig config;
    config.terrain.stiffness_N_per_m = v.stiffness_N_per_m;
    config.terrain.added_mass_factor = v.added_mass_factor;
    const auto stride = nominal_stride({}, config);
    const auto f = figures_of(stride);
    const auto last = std::find_if(stride.rows.rbegin(), stride.rows.rend(),
                                   [](const auto& row) { return row.phase == NominalPhase::extension; });
    const double liftoff_s = 1e-9 * static_cast<double>(last->truth.time_ns) + 1e-3;
    std::printf("k %.0f c_g %.0f: liftoff %.3f s (%.3f), peak %.2f N (%.1f), depth %.2f mm (%.1f)\n",
                v.stiffness_N_per_m, v.added_mass_factor, liftoff_s, v.liftoff_s, f.peak_force_N,
                v.peak_force_N, f.max_depth_mm, v.max_depth_mm);
    EXPECT_NEAR(liftoff_s, v.liftoff_s, 0.002);
    expect_printed(f.peak_force_N, v.peak_force_N, 0.1, "peak force");
    expect_printed(f.max_depth_mm, v.max_depth_mm, 0.1, "greatest depth");
  }
}

}  // namespace
}  // namespace sandhopper
