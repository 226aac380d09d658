// Writes a report of made-up strides: a page whose every number is known, for the browser test.
//   sample_page FILE STRIDES IDLE_S       IDLE_S: seconds between strides
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "tools/report/trial_page.hpp"

namespace {

using namespace sandhopper;

constexpr double kStance_s = 0.30;
constexpr double kFlight_s = 0.12;

// Channels at one instant, `t` seconds after touchdown (negative: before).
struct Sample {
  double depth_m = 0.0;
  double speed_mps = 0.0;
  double force_N = 0.0;
  double leg_m = 0.30;
};

Sample sample_at(double t_s) {
  Sample sample;
  if (t_s < 0.0) {
    sample.depth_m = t_s * (1.0 + 4.0 * t_s);
    sample.speed_mps = 1.0 + 8.0 * t_s;
    return sample;
  }
  const double share = std::min(t_s / kStance_s, 1.0);
  const double phase = std::numbers::pi * share;
  sample.depth_m = 0.02 * (1.0 - std::exp(-50.0 * t_s)) + 0.02 * std::pow(std::sin(0.5 * phase), 4);
  sample.speed_mps = std::exp(-50.0 * t_s) + 0.2 * std::sin(phase) * std::pow(std::sin(0.5 * phase), 2);
  sample.force_N = share < 1.0 ? 1500.0 * sample.depth_m + 20.0 * std::exp(-40.0 * t_s) * t_s * 100.0 : 0.0;
  sample.leg_m = 0.30 - 0.10 * std::sin(phase) + 0.04 * share;
  return sample;
}

ReportStride stride_at(std::uint32_t number, double touchdown_s) {
  ReportStride stride{.number = number,
                      .contact_s = touchdown_s,
                      .touchdown_s = touchdown_s,
                      .switch_s = touchdown_s + 0.14,
                      .liftoff_s = touchdown_s + kStance_s,
                      .touchdown_speed_mps = 1.0,
                      .peak_force_N = 60.0,
                      .max_depth_m = 0.04};
  stride.quasi_static_ols = {1100.0, 900.0, 1300.0, 4.0, 120, false, "deeper than the foot <is tall>"};
  stride.observer_ols = {1420.0 + number, 1300.0, 1540.0, 3.0, 120, true, ""};
  stride.observer_wls = {1480.0 + number, 1390.0, 1570.0, 2.0, 120, true, ""};
  stride.joint = {1500.0 + number, 1400.0, 1600.0, 4.5, 60, true, ""};
  return stride;
}

ReportData made_up(std::uint32_t strides, double idle_s) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double period_s = kFlight_s + kStance_s + idle_s;
  ReportData data;
  data.title = "Sample <trial> & co.";
  data.facts = {{"Board", "none"}, {"Strides", std::to_string(strides)}};
  data.notes = {"Made up: </script><script>document.title = 'broken'</script>"};
  data.configuration = "[robot]\nname = \"sample\"\n";
  data.columns = {
      {"estimate_leg_length_m", {}},    {"estimate_body_z_m", {}},          {"tof_height_m", {}},
      {"estimate_foot_z_m", {}},        {"estimate_foot_velocity_mps", {}}, {"estimate_foot_accel_mps2", {}},
      {"estimate_contact_force_N", {}}, {"quasi_static_force_N", {}},       {"load_cell_force_N", {}}};
  for (std::uint32_t i = 0; i < strides; ++i) {
    const double touchdown_s = i * period_s + kFlight_s;
    data.strides.push_back(stride_at(i + 1, touchdown_s));
    data.phases.push_back({touchdown_s, touchdown_s + 0.14, "compression"});
    data.phases.push_back({touchdown_s + 0.14, touchdown_s + kStance_s, "extension"});
    data.events.push_back({touchdown_s, i + 1, "touchdown", "leg_deflection", "leg length 298.0 mm"});
  }
  const auto rows = static_cast<std::int64_t>(std::lround(period_s * strides * 1000.0));
  for (std::int64_t row = 0; row < rows; ++row) {
    const double t_s = static_cast<double>(row) * 1e-3;
    const double in_period_s = std::fmod(t_s, period_s);
    const Sample now = sample_at(std::min(in_period_s - kFlight_s, kStance_s));
    // A single outlier in a long silence, which thinning must not lose.
    const double spike = row == 3 * rows / 4 ? 500.0 : 0.0;
    const double values[] = {now.leg_m,
                             0.12 + now.leg_m - now.depth_m,
                             row % 2 ? kNone : 0.12 + now.leg_m,
                             -now.depth_m,
                             -now.speed_mps,
                             50.0 * (1.0 - now.speed_mps),
                             now.force_N,
                             0.7 * now.force_N + spike,
                             row % 7 ? now.force_N + 1.0 : kNone};
    data.time_s.push_back(t_s);
    for (std::size_t i = 0; i < data.columns.size(); ++i) data.columns[i].values.push_back(values[i]);
  }
  return data;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: sample_page FILE STRIDES IDLE_S\n", stderr);
    return 2;
  }
  write_trial_report(made_up(static_cast<std::uint32_t>(std::atoi(argv[2])), std::atof(argv[3])), argv[1]);
}
