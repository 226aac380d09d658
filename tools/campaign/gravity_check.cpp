#include "tools/campaign/gravity_check.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>

#include "estimation/leg.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/integrated_twice.hpp"

namespace sandhopper {
namespace {

// Offset of the acceleration, from the position. Empty if an offset does not explain the difference, as where
// the accelerometer was saturated: then more than a tenth of the offset's own effect is left.
std::optional<double> offset_mps2(const TrialRecording& recording) {
  const auto rows = integrated_twice(recording, "foot_accel_mps2", "foot_z_m");
  if (rows.t_s.size() < 10) return std::nullopt;
  constexpr double kLeft = 0.1;
  Eigen::MatrixXd terms(static_cast<Eigen::Index>(rows.t_s.size()), 3);
  Eigen::VectorXd moved(terms.rows());
  for (Eigen::Index i = 0; i < terms.rows(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    const double t = rows.t_s[row] - rows.t_s.front();
    terms.row(i) << 1.0, t, -0.5 * t * t;
    moved[i] = rows.position_m[row] - rows.way_m[row];
  }
  const Eigen::VectorXd all = terms.colPivHouseholderQr().solve(moved);
  const Eigen::MatrixXd line = terms.leftCols(2);
  const Eigen::VectorXd of_line = line.colPivHouseholderQr().solve(moved);
  if ((moved - terms * all).norm() > kLeft * (moved - line * of_line).norm()) return std::nullopt;
  return all[2];
}

}  // namespace

void check_gravity(TrialRecording& recording, const RecordingPlaces& places) {
  if (!recording.has_time || !recording.has("foot_z_m") || !recording.has("foot_accel_mps2")) return;
  const auto offset = offset_mps2(recording);
  if (!offset || std::abs(std::abs(*offset) - kGravity_mps2) > 0.5 * kGravity_mps2) return;
  const double gravity_mps2 = std::copysign(kGravity_mps2, *offset);
  std::string cure = "subtract gravity";
  if (const auto* column = places.column_of("foot_accel_mps2")) {
    auto without = *column;
    without.offset -= gravity_mps2;
    cure = fmt::format("write {} into [columns]", mapping_line(without));
  }
  doubt_column(recording, places, places.is_stated("foot_accel_mps2"), "foot_accel_mps2",
               fmt::format("is {:.2f} m/s2 more than foot_z_m shows: it holds gravity, as an accelerometer "
                           "reads it; the channel is 0 at rest",
                           *offset),
               std::move(cure));
}

}  // namespace sandhopper
