#include "tools/campaign/gravity_check.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <optional>
#include <vector>

#include "estimation/leg.hpp"
#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

// Offset of the acceleration, from the position. Empty if an offset does not explain the difference, as where
// the accelerometer was saturated: then more than a tenth of the offset's own effect is left.
std::optional<double> offset_mps2(const TrialRecording& recording) {
  const auto z = recording.channel("foot_z_m"), a = recording.channel("foot_accel_mps2");
  std::vector<double> time_s, moved_m;
  double last_s = 0.0, last_mps2 = 0.0, speed_mps = 0.0, way_m = 0.0;
  bool began = false;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    if (std::isnan(a[i])) continue;
    const double step_s = began ? recording.t_s[i] - last_s : 0.0;
    way_m += step_s * (speed_mps + step_s * (last_mps2 / 3.0 + a[i] / 6.0));
    speed_mps += 0.5 * step_s * (last_mps2 + a[i]);
    last_s = recording.t_s[i];
    last_mps2 = a[i];
    began = true;
    if (std::isnan(z[i])) continue;
    time_s.push_back(last_s);
    moved_m.push_back(z[i] - way_m);
  }
  if (time_s.size() < 10) return std::nullopt;
  constexpr double kLeft = 0.1;
  Eigen::MatrixXd terms(static_cast<Eigen::Index>(time_s.size()), 3);
  Eigen::VectorXd moved(terms.rows());
  for (Eigen::Index i = 0; i < terms.rows(); ++i) {
    const double t = time_s[static_cast<std::size_t>(i)] - time_s.front();
    terms.row(i) << 1.0, t, -0.5 * t * t;
    moved[i] = moved_m[static_cast<std::size_t>(i)];
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
