#include "tools/calibrate/imu.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/imu/ism330dhcx_protocol.hpp"
#include "terrain/trial_statistics.hpp"

namespace sandhopper::calibrate {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr std::size_t kFewestPoses = 9;     // six unknowns, and three poses to detect a bad fit
constexpr double kAccelWander_mps2 = 0.03;  // allowed drift within a pose, beyond noise
constexpr double kGyroWander_radps = 0.01;
constexpr double kNearFace = 0.85;  // least cosine between a pose and a face of the sensor

// Means over one pose, uncorrected, in the sensor's own axes.
struct Pose {
  Eigen::Vector3d accel_mps2, gyro_radps;
  double error_mps2;  // standard error of the mean of the worst axis
};

Pose measure(const Recording& recording, const ImuChoice& which, const ImuConfig& config,
             std::vector<Refusal>& refusals) {
  const auto& samples = recording.*which.samples;
  const double end_mps2 = 0.98 * config.accel_range_g * kGravity_mps2;
  Pose out{};
  bool at_the_end = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto accel = series_of(
        samples, [&](const ImuSample& s) { return ism330dhcx::raw_accel_mps2(s.accel_mps2, config)[axis]; });
    const auto gyro = series_of(
        samples, [&](const ImuSample& s) { return ism330dhcx::raw_gyro_radps(s.gyro_radps, config)[axis]; });
    at_the_end |= std::ranges::any_of(accel.value, [&](double v) { return std::abs(v) > end_mps2; });
    const auto name = fmt::format("{}, {}, axis {}", recording.name, which.table, "xyz"[axis]);
    const auto before = refusals.size();
    const auto mean = still_mean(accel, {.max_wander = kAccelWander_mps2}, name + ", m/s²", refusals);
    if (refusals.size() == before)
      out.gyro_radps[static_cast<Eigen::Index>(axis)] =
          still_mean(gyro, {.max_wander = kGyroWander_radps}, name + ", rate in rad/s", refusals).value;
    out.accel_mps2[static_cast<Eigen::Index>(axis)] = mean.value;
    out.error_mps2 = std::max(out.error_mps2, mean.standard_error);
  }
  if (at_the_end)
    refusals.push_back(
        {"saturated",
         fmt::format("{}: {} reaches the end of its {} g", recording.name, which.table, config.accel_range_g),
         "lay it down gently, or choose a wider accel_range_g"});
  return out;
}

void check_faces(const std::vector<Pose>& poses, std::vector<Refusal>& refusals) {
  std::string missing;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0})
      if (std::ranges::none_of(poses, [&](const Pose& p) {
            return sign * p.accel_mps2[axis] > kNearFace * p.accel_mps2.norm();
          }))
        missing += fmt::format(" {}{}", sign > 0.0 ? '+' : '-', "xyz"[axis]);
  if (!missing.empty())
    refusals.push_back({"poses_too_alike", fmt::format("no pose has the sensor's axis up:{}", missing),
                        "lay it on each of its six faces, and three or more poses besides"});
}

// `value`: scale - 1 (three axes), then bias (three axes). `residual`: |S (m - b)| - g of each pose.
struct Fit {
  Vector6 value = Vector6::Zero();
  Matrix6 inverse_normal = Matrix6::Zero();
  Eigen::VectorXd residual;
};
Fit fit(const std::vector<Pose>& poses, double gravity_mps2) {
  const auto n = static_cast<Eigen::Index>(poses.size());
  Fit out;
  out.residual.resize(n);
  Eigen::Matrix<double, Eigen::Dynamic, 6> jacobian(n, 6);
  for (int iteration = 0; iteration < 10; ++iteration) {
    const Eigen::Array3d scale = 1.0 + out.value.head<3>().array();
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Array3d centred =
          poses[static_cast<std::size_t>(k)].accel_mps2.array() - out.value.tail<3>().array();
      const Eigen::Array3d force = scale * centred;
      const double length = force.matrix().norm();
      out.residual[k] = length - gravity_mps2;
      jacobian.row(k).head<3>() = force * centred / length;
      jacobian.row(k).tail<3>() = -force * scale / length;
    }
    const Matrix6 normal = jacobian.transpose() * jacobian;
    out.inverse_normal = normal.ldlt().solve(Matrix6::Identity());
    const Vector6 step = out.inverse_normal * (jacobian.transpose() * out.residual);
    if (step.norm() < 1e-12) break;
    out.value -= step;
  }
  return out;
}

std::string name_of_worst(const std::vector<Pose>& poses, double gravity_mps2, double allowed) {
  for (std::size_t k = 0; poses.size() > kFewestPoses && k < poses.size(); ++k) {
    auto others = poses;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    if (fit(others, gravity_mps2).residual.cwiseAbs().maxCoeff() < allowed) return std::to_string(k + 1);
  }
  return {};
}

void judge(const std::vector<Pose>& poses, const Fit& found, const ImuLimits& limits, double error_mps2,
           std::vector<Refusal>& refusals) {
  const double allowed = std::hypot(limits.max_residual_mps2, 5.0 * error_mps2);
  const double worst = found.residual.cwiseAbs().maxCoeff();
  if (worst <= allowed) return;
  const auto text =
      fmt::format("a pose feels {:.3f} m/s² more or less than gravity, allowed {:.3f}", worst, allowed);
  if (const auto pose = name_of_worst(poses, limits.gravity_mps2, allowed); !pose.empty())
    refusals.push_back({"outlier", fmt::format("{}; without pose {} all others fit", text, pose),
                        "record this pose again, lying still on something firm"});
  else
    refusals.push_back({"residual_too_large", text,
                        "lay it on something firm, away from running machines; a sensor whose axes are not "
                        "rectangular by more than 0.3 degrees cannot be calibrated this way"});
}

struct GyroBias {
  std::array<double, 3> value{}, ci95{};
};
GyroBias gyro_bias(const std::vector<Pose>& poses) {
  GyroBias out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> rates;
    for (const auto& pose : poses) rates.push_back(pose.gyro_radps[static_cast<Eigen::Index>(axis)]);
    const auto mean = mean_over_trials(rates);
    out.value[axis] = mean.value;
    out.ci95[axis] = 0.5 * (mean.ci95_high - mean.ci95_low);
  }
  return out;
}

StudySection section_of(const std::vector<Pose>& poses, const Fit& found, const std::string& table_name,
                        double gravity_mps2) {
  StudySection section{.title = table_name};
  StudyFigure residual{.title = "Length of each pose's specific force less gravity",
                       .x_label = "pose",
                       .y_label = "length less gravity, m/s²"};
  StudySeries before{.label = "as delivered", .color = "grey"}, after{.label = "calibrated"};
  StudyTable table{.title = "Poses", .columns = {"pose", "x, m/s²", "y, m/s²", "z, m/s²", "residual, m/s²"}};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const auto& a = poses[k].accel_mps2;
    const double rest = found.residual[static_cast<Eigen::Index>(k)];
    before.x.push_back(static_cast<double>(k + 1));
    after.x.push_back(static_cast<double>(k + 1));
    before.y.push_back(a.norm() - gravity_mps2);
    after.y.push_back(rest);
    table.rows.push_back({std::to_string(k + 1), fmt::format("{:.4f}", a.x()), fmt::format("{:.4f}", a.y()),
                          fmt::format("{:.4f}", a.z()), fmt::format("{:+.4f}", rest)});
  }
  residual.series = {before, after};
  section.items = {residual, table};
  return section;
}

}  // namespace

Outcome calibrate_imu(const std::vector<Recording>& poses, const ImuChoice& which, const ImuConfig& before,
                      const ImuLimits& limits) {
  Outcome out{.points = poses.size(), .residual_unit = "m/s²"};
  if (poses.size() < kFewestPoses) {
    out.refusals.push_back({"too_few_points",
                            fmt::format("{} poses, at least {} are needed", poses.size(), kFewestPoses),
                            "lay it on each of its six faces, and three or more poses besides"});
    return out;
  }
  std::vector<Pose> measured;
  for (const auto& pose : poses) measured.push_back(measure(pose, which, before, out.refusals));
  if (out.refusals.empty()) check_faces(measured, out.refusals);
  if (!out.refusals.empty()) return out;
  const auto found = fit(measured, limits.gravity_mps2);
  const double error = std::ranges::max_element(measured, {}, &Pose::error_mps2)->error_mps2;
  const double freedom = static_cast<double>(poses.size() - 6);
  const double sd = std::sqrt(found.residual.squaredNorm() / freedom);
  const double half = student_t95(poses.size() - 6) * std::max(sd, error);
  const auto gyro = gyro_bias(measured);
  out.residual_rms = sd;
  Outcome::Target target{ConfigFile::board, which.table, {}};
  bool wide = false;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const double scale_ci = half * std::sqrt(found.inverse_normal(i, i));
    const double bias_ci = half * std::sqrt(found.inverse_normal(i + 3, i + 3));
    const auto key = [&](const char* name) { return fmt::format("{}.{}[{}]", which.table, name, i); };
    target.values.push_back(
        {key("accel_scale"), "", before.accel_scale[axis], 1.0 + found.value[i], scale_ci});
    target.values.push_back(
        {key("accel_bias_mps2"), "m/s²", before.accel_bias_mps2[axis], found.value[i + 3], bias_ci});
    target.values.push_back(
        {key("gyro_bias_radps"), "rad/s", before.gyro_bias_radps[axis], gyro.value[axis], gyro.ci95[axis]});
    wide |= scale_ci > limits.max_scale_ci95 || bias_ci > limits.max_bias_ci95_mps2 ||
            gyro.ci95[axis] > limits.max_gyro_ci95_radps;
  }
  out.targets = {target};
  out.sections = {section_of(measured, found, which.table, limits.gravity_mps2)};
  judge(measured, found, limits, error, out.refusals);
  if (wide)
    out.refusals.push_back(
        {"interval_too_wide",
         fmt::format("asked for are {} of the scale, {} m/s² of the bias and {} rad/s of the gyro",
                     limits.max_scale_ci95, limits.max_bias_ci95_mps2, limits.max_gyro_ci95_radps),
         "record each of the six faces twice, lying still"});
  return out;
}

}  // namespace sandhopper::calibrate
