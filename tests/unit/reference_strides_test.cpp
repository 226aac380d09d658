#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tools/experiment/nominal_stride.hpp"

// Default robot and bed without noise, compared with 15 strides of an independent program and with the
// printed matrix of these strides.
namespace sandhopper {
namespace {

struct Cell {
  double speed_mps, stiffness_N_per_m, height_m;
};
constexpr std::array<Cell, 15> kCells{{{.2, 250, .0025},
                                       {.2, 375, .0025},
                                       {.2, 500, .0025},
                                       {.45, 250, .0125},
                                       {.45, 375, .0125},
                                       {.45, 500, .0125},
                                       {.7, 250, .0303},
                                       {.7, 375, .0303},
                                       {.7, 500, .0303},
                                       {1.0, 250, .0618},
                                       {1.0, 375, .0618},
                                       {1.0, 500, .0618},
                                       {1.2, 250, .0890},
                                       {1.2, 375, .0890},
                                       {1.2, 500, .0890}}};

struct ReferenceRow {
  double t_s, body_z_m, body_velocity_mps, foot_z_m, foot_velocity_mps, angle_rad, angular_velocity_radps,
      torque_Nm, contact_force_N, max_depth_m;
  int phase;
};

std::filesystem::path shared_data() {
  if (const char* set = std::getenv("SANDHOPPER_SHARED_DATA")) return set;
  return std::filesystem::path(SANDHOPPER_SOURCE_DIR) / ".." / "shared" / "data";
}

std::vector<ReferenceRow> reference(const Cell& cell) {
  char name[64];
  std::snprintf(name, sizeof name, "v%.2f_k%.0f.csv", cell.speed_mps, cell.stiffness_N_per_m);
  std::ifstream file(shared_data() / "reference_strides" / name);
  std::vector<ReferenceRow> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream in(line);
    ReferenceRow r{};
    in >> r.t_s >> r.body_z_m >> r.body_velocity_mps >> r.foot_z_m >> r.foot_velocity_mps >> r.angle_rad >>
        r.angular_velocity_radps >> r.torque_Nm >> r.contact_force_N >> r.max_depth_m >> r.phase;
    if (in) rows.push_back(r);
  }
  return rows;
}

class ReferenceStrides : public ::testing::TestWithParam<Cell> {};

TEST_P(ReferenceStrides, AreReproduced) {
  const auto& cell = GetParam();
  const auto expected = reference(cell);
  if (expected.empty())
    GTEST_SKIP() << "NOT CHECKED: no reference strides in " << shared_data()
                 << "; set SANDHOPPER_SHARED_DATA to the folder that holds reference_strides/";
  const auto stride = nominal_stride({.release_height_m = cell.height_m,
                                      .compression_stiffness_N_per_m = cell.stiffness_N_per_m,
                                      .milliseconds = static_cast<int>(expected.size())});
  double force2 = 0.0, body2 = 0.0, foot2 = 0.0, torque_worst = 0.0;
  int phase_mismatches = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& row = stride.rows[i];
    force2 += std::pow(row.mean_force_N - expected[i].contact_force_N, 2);
    body2 += std::pow(row.truth.body_z_m - expected[i].body_z_m, 2);
    foot2 += std::pow(row.truth.foot_z_m - expected[i].foot_z_m, 2);
    torque_worst = std::max(torque_worst, std::abs(row.truth.motor_torque_Nm - expected[i].torque_Nm));
    if (static_cast<int>(row.phase) != expected[i].phase) ++phase_mismatches;
  }
  const double n = static_cast<double>(expected.size());
  const double force_N = std::sqrt(force2 / n), body_m = std::sqrt(body2 / n), foot_m = std::sqrt(foot2 / n);
  std::printf(
      "v %.2f k_c %3.0f: rms force %.2e N, body %.2e mm, foot %.2e mm; worst torque %.1e N m; rows in "
      "another phase %d\n",
      cell.speed_mps, cell.stiffness_N_per_m, force_N, body_m * 1e3, foot_m * 1e3, torque_worst,
      phase_mismatches);
  EXPECT_LE(force_N, 0.2);
  EXPECT_LE(body_m, 0.02e-3);
  EXPECT_LE(foot_m, 0.02e-3);
  EXPECT_EQ(phase_mismatches, 0);
}

INSTANTIATE_TEST_SUITE_P(AllCells, ReferenceStrides, ::testing::ValuesIn(kCells));

}  // namespace
}  // namespace sandhopper
