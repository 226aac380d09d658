#include "tools/calibrate/torque_constant.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "drivers/adc/ads1115.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/calibrate/devices.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr double kBin_s = 0.05;
constexpr double kTurning_s = 0.3;      // left out after a turning point: friction changes its sign gradually
constexpr double kMostMove_rad = 0.02;  // largest move of a clamped leg
constexpr double kLeastForce_N = 8.0;

// Means over the bins of one press. A positive "pressing" current lengthens the leg.
struct Press {
  std::vector<double> force_N;
  std::array<std::vector<double>, kMotorCount> pressing_A;  // -current
  std::vector<double> direction;  // +1: the currents grow, -1: they fall, 0: bin not used
  double lever_m_per_rad = 0.0;   // |dL/dphi|
};

// Mean of each bin, starting at `begin_ns`; NaN for a bin without samples.
template <class Sample, class Figure>
std::vector<double> binned(const std::vector<Sample>& samples, std::int64_t begin_ns, std::size_t bins,
                           Figure&& figure) {
  std::vector<double> sum(bins, 0.0), count(bins, 0.0);
  for (const auto& sample : samples) {
    const double place = static_cast<double>(sample.time_ns - begin_ns) * 1e-9 / kBin_s;
    if (place < 0.0 || place >= static_cast<double>(bins)) continue;
    sum[static_cast<std::size_t>(place)] += figure(sample);
    count[static_cast<std::size_t>(place)] += 1.0;
  }
  for (std::size_t i = 0; i < bins; ++i) sum[i] /= count[i];
  return sum;
}

double total_at(const Press& press, std::size_t i) { return press.pressing_A[0][i] + press.pressing_A[1][i]; }

// +1 or -1 in bins in which the current has grown or fallen steadily for kTurning_s, otherwise 0.
std::vector<double> directions(const Press& press) {
  const std::size_t n = press.force_N.size();
  std::vector<double> slope(n, 0.0);
  for (std::size_t i = 1; i + 1 < n; ++i) slope[i] = total_at(press, i + 1) - total_at(press, i - 1);
  auto sorted = slope;
  for (auto& value : sorted) value = std::abs(value);
  std::ranges::sort(sorted);
  const double steady = 0.3 * sorted[n * 9 / 10];
  const auto wait = static_cast<std::size_t>(kTurning_s / kBin_s);
  std::vector<double> out(n, 0.0);
  std::size_t since = 0;
  double running = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double now = std::abs(slope[i]) < steady ? 0.0 : std::copysign(1.0, slope[i]);
    since = now == running && now != 0.0 ? since + 1 : 0;
    running = now;
    if (since >= wait) out[i] = running;
  }
  return out;
}

void check(const Recording& r, const LoadCellConfig& cell, std::size_t motors,
           std::vector<Refusal>& refusals) {
  const double full_V = ads1115_full_scale_V(cell.range);
  if (!cell.is_iio() && std::ranges::any_of(r.load_cell, [&](const auto& s) {
        return std::abs(load_cell_voltage_V(s.force_N, cell)) > 0.995 * full_V;
      }))
    refusals.push_back({"saturated", r.name + ": the load cell is at the end of its converter",
                        "press less (--peak-torque-Nm), or choose a wider load_cell.range"});
  for (std::size_t i = 0; i < motors; ++i) {
    if (r.motor[i].empty()) continue;
    const auto [low, high] = std::ranges::minmax(r.motor[i], {}, &MotorSample::position_rad);
    if (high.position_rad - low.position_rad > kMostMove_rad)
      refusals.push_back(
          {"moving",
           fmt::format("{}: the {} link turned by {:.3f} rad, allowed {} rad", r.name,
                       i == 0 ? "left" : "right", high.position_rad - low.position_rad, kMostMove_rad),
           "clamp body and foot more firmly, or press less"});
  }
}

Press measure(const Recording& r, const LinuxBoardConfig& board, const Leg& leg,
              std::vector<Refusal>& refusals) {
  const auto motors = static_cast<std::size_t>(leg.parameters().motor_count);
  Press out;
  if (r.load_cell.size() < 500 || r.motor[0].size() < 500 || (motors == 2 && r.motor[1].size() < 500)) {
    refusals.push_back({"too_few_samples", r.name + ": load cell or motors hardly delivered",
                        "`hop doctor` says which device does not deliver"});
    return out;
  }
  check(r, board.load_cell, motors, refusals);
  const auto begin_ns = r.load_cell.front().time_ns;
  const auto bins =
      static_cast<std::size_t>(static_cast<double>(r.load_cell.back().time_ns - begin_ns) * 1e-9 / kBin_s);
  out.force_N = binned(r.load_cell, begin_ns, bins, [](const auto& s) { return s.force_N; });
  double angle_rad = 0.0;
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    out.pressing_A[i] = i < motors
                            ? binned(r.motor[i], begin_ns, bins, [](const auto& s) { return -s.current_A; })
                            : std::vector<double>(bins, 0.0);
    for (const auto& s : r.motor[i])
      if (i < motors) angle_rad += s.position_rad / static_cast<double>(motors * r.motor[i].size());
  }
  out.lever_m_per_rad = std::abs(leg.kinematics(angle_rad).dlength_m_per_rad);
  out.direction = directions(out);
  const auto [low, high] = std::ranges::minmax(out.force_N);
  if (high - low < kLeastForce_N)
    refusals.push_back(
        {"too_little_force",
         fmt::format("{}: the force changed by {:.1f} N, at least {} N are needed", r.name, high - low,
                     kLeastForce_N),
         "see that the foot stands on something firm and the body is clamped; raise --peak-torque-Nm"});
  return out;
}

// k_left, k_right, o and f of one press, see calibrate_torque_constant().
struct PressFit {
  Eigen::Vector4d value = Eigen::Vector4d::Zero();
  double residual_Nm = 0.0;
  std::vector<double> time_s, residual;
};
PressFit fit_press(const Press& press, bool both) {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < press.force_N.size(); ++i)
    if (press.direction[i] != 0.0 && std::isfinite(press.force_N[i]) && std::isfinite(total_at(press, i)))
      used.push_back(i);
  const auto n = static_cast<Eigen::Index>(used.size());
  Eigen::MatrixX4d design(n, 4);
  Eigen::VectorXd torque(n);
  for (Eigen::Index row = 0; row < n; ++row) {
    const auto i = used[static_cast<std::size_t>(row)];
    design.row(row) << press.pressing_A[0][i], both ? press.pressing_A[1][i] : 0.0, 1.0, -press.direction[i];
    torque[row] = press.lever_m_per_rad * press.force_N[i];
  }
  PressFit out;
  if (n < 12) return out;
  out.value = design.colPivHouseholderQr().solve(torque);
  const Eigen::VectorXd residual = torque - design * out.value;
  out.residual_Nm = std::sqrt(residual.squaredNorm() / static_cast<double>(n - 4));
  for (Eigen::Index row = 0; row < n; ++row) {
    out.time_s.push_back(kBin_s * (static_cast<double>(used[static_cast<std::size_t>(row)]) + 0.5));
    out.residual.push_back(residual[row]);
  }
  return out;
}

StudySection section_of(const std::vector<Press>& presses, const std::vector<PressFit>& fits) {
  StudySection section{.title = "Presses"};
  StudyFigure loop{.title = "Force at the load cell as torque, against current",
                   .x_label = "both currents, A",
                   .y_label = "torque of both motors, N m",
                   .note = "The loop's height is twice the friction."};
  StudyFigure residual{.title = "Residuals", .x_label = "time, s", .y_label = "torque less the fit, N m"};
  StudyTable table{.title = "Fits",
                   .columns = {"press", "left, N m/A", "right, N m/A", "friction, N m", "residual, N m"}};
  for (std::size_t p = 0; p < presses.size(); ++p) {
    StudySeries points{.label = fmt::format("press {}", p + 1), .shown = p == 0};
    for (std::size_t i = 0; i < presses[p].force_N.size(); ++i) {
      points.x.push_back(total_at(presses[p], i));
      points.y.push_back(presses[p].lever_m_per_rad * presses[p].force_N[i]);
    }
    tell_apart(points, p);
    loop.series.push_back(points);
    residual.series.push_back({.label = fmt::format("press {}", p + 1),
                               .x = fits[p].time_s,
                               .y = fits[p].residual,
                               .shown = p == 0});
    tell_apart(residual.series.back(), p);
    const auto& v = fits[p].value;
    table.rows.push_back({std::to_string(p + 1), fmt::format("{:.5f}", v[0]), fmt::format("{:.5f}", v[1]),
                          fmt::format("{:.4f}", v[3]), fmt::format("{:.4f}", fits[p].residual_Nm)});
  }
  section.items = {loop, residual, table};
  return section;
}

double span_Nm(const Press& press) {
  const auto [low, high] = std::ranges::minmax(press.force_N);
  return press.lever_m_per_rad * (high - low);
}

void judge_fits(const std::vector<Press>& presses, const std::vector<PressFit>& fits,
                double max_residual_of_span, std::vector<Refusal>& refusals) {
  for (std::size_t p = 0; p < fits.size(); ++p) {
    const double share = fits[p].residual_Nm / span_Nm(presses[p]);
    if (!fits[p].residual.empty() && share <= max_residual_of_span) continue;
    refusals.push_back({"residual_too_large",
                        fmt::format("press {} leaves {:.1f} % of its span, allowed {:.1f} %", p + 1,
                                    100.0 * share, 100.0 * max_residual_of_span),
                        "press slowly, with nothing that rubs or gives; use the program of this command"});
    return;
  }
}

}  // namespace

double PressProgram::duration_s() const {
  return (motor_count == 2 ? 3.0 : 1.0) * (pause_s + 2.0 * ramp_s) + pause_s;
}

std::array<double, kMotorCount> PressProgram::torque_Nm(double time_s) const {
  const double period = pause_s + 2.0 * ramp_s;
  const int part = static_cast<int>(time_s / period);
  const double in_ramp = std::max(0.0, time_s - part * period - pause_s) / ramp_s;
  const double torque = -peak_torque_Nm * (in_ramp < 1.0 ? in_ramp : std::max(0.0, 2.0 - in_ramp));
  if (motor_count == 1) return {part == 0 ? torque : 0.0, 0.0};
  return {part == 0 || part == 2 ? torque : 0.0, part == 1 || part == 2 ? torque : 0.0};
}

Outcome calibrate_torque_constant(const std::vector<Recording>& presses, const LinuxBoardConfig& board,
                                  const Leg& leg, const TorqueConstantSetup& setup) {
  Outcome out{.points = presses.size(), .residual_unit = "N m"};
  if (presses.size() < 3) {
    out.refusals.push_back({"too_few_points",
                            fmt::format("{} presses, at least 3 are needed", presses.size()),
                            "press more often: --repeats 4"});
    return out;
  }
  const auto motors = static_cast<std::size_t>(leg.parameters().motor_count);
  std::vector<Press> measured;
  for (const auto& recording : presses) measured.push_back(measure(recording, board, leg, out.refusals));
  if (!out.refusals.empty()) return out;
  std::vector<PressFit> fits;
  for (const auto& press : measured) fits.push_back(fit_press(press, motors == 2));
  Outcome::Target target{ConfigFile::robot, "torque_constant", {}};
  for (std::size_t i = 0; i < motors; ++i) {
    std::vector<double> constants;
    for (const auto& one : fits) constants.push_back(one.value[static_cast<Eigen::Index>(i)]);
    const auto mean = mean_over_trials(constants);
    const double ci95 = std::hypot(mean.ci95_high - mean.value, setup.load_cell_ci95_relative * mean.value);
    target.values.push_back({.key = fmt::format("motor[{}].torque_constant_Nm_per_A", i),
                             .unit = "N m/A",
                             .before = board.can.motor[i].torque_constant_Nm_per_A,
                             .after = mean.value,
                             .ci95 = ci95});
    if (mean.value <= 0.0)
      out.refusals.push_back({"wrong_sign",
                              fmt::format("motor {} presses less with more current", board.can.motor[i].name),
                              "set signs first: `hop calibrate encoders`, `hop calibrate load-cell`"});
    else if (ci95 > setup.max_ci95_relative * mean.value)
      out.refusals.push_back(
          {"interval_too_wide",
           fmt::format("the constant of motor {} is known to {:.1f} % only, {:.1f} % are asked for",
                       board.can.motor[i].name, 100.0 * ci95 / mean.value, 100.0 * setup.max_ci95_relative),
           "press more often and harder, and calibrate the load cell better"});
  }
  judge_fits(measured, fits, setup.max_residual_of_span, out.refusals);
  if (setup.load_cell_ci95_relative == 0.0)
    out.notes.push_back(
        "the load cell was never calibrated: an error of its scale is one of these constants, and "
        "not in their intervals");
  double squares = 0.0;
  for (const auto& one : fits)
    squares += one.residual_Nm * one.residual_Nm / static_cast<double>(fits.size());
  out.residual_rms = std::sqrt(squares);
  out.targets = {target};
  out.sections = {section_of(measured, fits)};
  return out;
}

}  // namespace sandhopper::calibrate
