#include "tools/calibrate/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "drivers/adc/ads1115.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/calibrate/clock_step.hpp"
#include "tools/calibrate/devices.hpp"
#include "tools/calibrate/foreign_time.hpp"
#include "tools/calibrate/line.hpp"
#include "tools/calibrate/tap_alignment.hpp"
#include "tools/calibrate/tap_intervals.hpp"
#include "tools/calibrate/taps.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr std::size_t kFewestTaps = 5;
constexpr double kSearch_s = 0.010;
// Systematic error of interpolating the reference, whose samples are 1 ms apart; the same in all taps (95 %).
constexpr double kInterpolation_s = 1e-5;
constexpr double kMostUnexplained = 0.15;  // share of a tap's variance; above it the shapes differ

constexpr std::array<const char*, 3> kNames{"imu_body", "imu_foot", "load_cell"};
const char* name_of(TapSensor sensor) { return kNames[static_cast<std::size_t>(sensor)]; }

// Series with times relative to the recording's first cycle.
template <class Sample, class Figure>
Series timed(const Recording& r, const std::vector<Sample>& samples, Figure&& figure) {
  auto out = series_of(samples, figure);
  for (std::size_t i = 0; i < samples.size(); ++i)
    out.time_s[i] = static_cast<double>(samples[i].time_ns - r.begin_ns) * 1e-9;
  return out;
}

Series signal_of(const Recording& r, TapSensor sensor) {
  const auto accel = [](const ImuSample& s) { return s.accel_mps2[2]; };
  if (sensor == TapSensor::imu_body) return timed(r, r.imu_body, accel);
  if (sensor == TapSensor::imu_foot) return timed(r, r.imu_foot, accel);
  return timed(r, r.load_cell, [](const LoadCellSample& s) { return s.force_N; });
}

double latency_s(const LinuxBoardConfig& board, TapSensor sensor) {
  if (sensor == TapSensor::imu_body) return board.imu_body.latency_s;
  return sensor == TapSensor::imu_foot ? board.imu_foot.latency_s : board.load_cell.latency_s;
}

double end_of_range(const LinuxBoardConfig& board, TapSensor sensor) {
  if (sensor == TapSensor::load_cell)
    return 0.995 * (ads1115_full_scale_V(board.load_cell.range) - std::abs(board.load_cell.zero_V)) *
           board.load_cell.scale_N_per_V;
  const auto& imu = sensor == TapSensor::imu_body ? board.imu_body : board.imu_foot;
  return 0.97 * imu.accel_range_g * kGravity_mps2;
}

void check_range(const Series& signal, const LinuxBoardConfig& board, TapSensor sensor,
                 std::vector<Refusal>& refusals) {
  const double end = end_of_range(board, sensor);
  if (std::ranges::any_of(signal.value, [&](double v) { return std::abs(v) > end; }))
    refusals.push_back({"saturated", fmt::format("{} is at the end of its range in a tap", name_of(sensor)),
                        "tap more softly, or choose a wider range"});
}

// Delay of one signal against the reference, for each tap.
struct Delays {
  std::vector<double> tap_s, delay_s;
};
Delays delays_of(const Series& reference, const Series& other, const std::vector<double>& taps,
                 const std::function<double(double)>& centre_s, const std::string& name,
                 std::vector<Refusal>& refusals) {
  Delays out;
  std::size_t strange = 0;
  for (const double tap_s : taps) {
    const auto delay = delay_of(reference, other, {tap_s, kSearch_s, centre_s(tap_s)});
    strange += !delay.found || delay.unexplained > kMostUnexplained;
    out.tap_s.push_back(tap_s);
    out.delay_s.push_back(delay.delay_s);
  }
  if (strange > 0)
    refusals.push_back(
        {"residual_too_large",
         fmt::format("{}: {} of {} taps do not look as in the reference, or lie more than {} ms apart", name,
                     strange, taps.size(), 1e3 * kSearch_s),
         "tap where both sensors feel the same; take only the recording's part with the taps; switch off "
         "what rounds a tap, as a mean over several samples or a filter"});
  return out;
}

StudyFigure figure_of(const Delays& delays, const TrialMean& mean, const std::string& name) {
  StudyFigure figure{.title = "Delay of " + name + ", tap by tap",
                     .x_label = "time, s",
                     .y_label = "delay less its mean, s"};
  StudySeries series{.label = name, .x = delays.tap_s};
  for (const double delay : delays.delay_s) series.y.push_back(delay - mean.value);
  figure.series = {series};
  return figure;
}

void calibrate_sensor(const Recording& r, const LinuxBoardConfig& board, TapSensor sensor,
                      const Series& reference, const std::vector<double>& taps, const TimingSetup& setup,
                      Outcome& out) {
  const auto signal = signal_of(r, sensor);
  check_range(signal, board, sensor, out.refusals);
  const auto delays = delays_of(
      reference, signal, taps, [](double) { return 0.0; }, name_of(sensor), out.refusals);
  const auto mean = mean_over_trials(delays.delay_s);
  const double ci95 = std::hypot(mean.ci95_high - mean.value, kInterpolation_s);
  double after = latency_s(board, sensor) + mean.value;
  if (std::abs(after) < ci95) after = 0.0;
  out.targets.front().values.push_back({.key = fmt::format("{}.latency_s", name_of(sensor)),
                                        .unit = "s",
                                        .before = latency_s(board, sensor),
                                        .after = after,
                                        .ci95 = ci95});
  out.residual_rms = std::max(out.residual_rms, mean.standard_deviation);
  out.sections.front().items.emplace_back(figure_of(delays, mean, name_of(sensor)));
  if (ci95 > setup.max_ci95_s)
    out.refusals.push_back({"interval_too_wide",
                            fmt::format("the delay of {} is known to {:.3f} ms only, {:.3f} ms are asked for",
                                        name_of(sensor), 1e3 * ci95, 1e3 * setup.max_ci95_s),
                            "tap more often, always in the same way"});
  if (after < 0.0)
    out.refusals.push_back(
        {"negative_latency",
         fmt::format("the latency of {} would be {:.3f} ms", name_of(sensor), 1e3 * after),
         fmt::format("the reference is older than it says: raise {}.latency_s by that much, or take "
                     "another --reference",
                     name_of(setup.reference))});
}

Refusal refusal_of(const ClockStep& step, const std::string& name) {
  return {
      "clock_steps",
      fmt::format("the clock of {} was set {} by {:.3f} s between {:.3f} and {:.3f} s of its time", name,
                  step.step_s > 0.0 ? "forward" : "back", std::abs(step.step_s), step.before_s, step.after_s),
      "stop time synchronisation on that computer while it records; or give the part before or after it "
      "alone"};
}

Refusal refusal_of(const ClockDrift& drift, const std::string& name) {
  return {"clock_drifts",
          fmt::format("the clock of {} runs {:.2f} % {}: the time between its taps is {} by the same share, "
                      "{} taps within {:.1f} ms",
                      name, 1e2 * std::abs(drift.fast), drift.fast > 0.0 ? "fast" : "slow",
                      drift.fast > 0.0 ? "longer" : "shorter", drift.taps, 1e3 * drift.residual_s),
          fmt::format("multiply its t_s by {:.6f} and calibrate again; if it counts rows, its true rate is "
                      "not the stated one",
                      1.0 / (1.0 + drift.fast))};
}

TapTimes times_of(const std::vector<double>& taps, const Series& signal) {
  return {taps, signal.time_s.front(), signal.time_s.back()};
}

// The offset at which the foreign taps coincide with ours, or a refusal.
std::optional<double> coarse_offset(const TapTimes& ours, const ForeignRecording& foreign,
                                    double least_step_s, std::vector<Refusal>& refusals) {
  std::vector<Refusal> refused;
  const auto taps = find_taps(foreign.signal, {kFewestTaps, foreign.name}, refused);
  const auto theirs = foreign.signal.time_s.empty() ? TapTimes{} : times_of(taps, foreign.signal);
  const auto alignments = tap_alignments(ours, theirs);
  if (alignments.empty() && !foreign.signal.time_s.empty())
    if (const auto unit = unit_that_fits(ours, foreign.signal)) {
      refusals.push_back(
          {"time_unit",
           fmt::format("the taps of {} fit ours if its t_s is in {}, not in s", foreign.name, *unit),
           "say so: --foreign-time-unit " + *unit});
      return std::nullopt;
    }
  refusals.insert(refusals.end(), refused.begin(), refused.end());
  if (!refused.empty()) return std::nullopt;
  const auto step = step_between_taps(ours.tap_s, taps);
  if (step || alignments.empty())
    if (const auto drift = drift_between_taps(ours.tap_s, taps, least_step_s)) {
      refusals.push_back(refusal_of(*drift, foreign.name));
      return std::nullopt;
    }
  if (step) {
    refusals.push_back(refusal_of(*step, foreign.name));
    return std::nullopt;
  }
  if (alignments.empty()) {
    refusals.push_back(different_taps(foreign.name, ours.tap_s, taps));
    return std::nullopt;
  }
  if (const auto rivals = rivals_of_first(alignments); !rivals.empty()) {
    refusals.push_back(ambiguous_alignment(foreign.name, alignments.front(), rivals));
    return std::nullopt;
  }
  return alignments.front().offset_s;
}

void calibrate_clock(const Series& reference, const std::vector<double>& taps, const TimingSetup& setup,
                     std::optional<ForeignClock>& clock, Outcome& out) {
  const auto& foreign = *setup.foreign;
  const auto offset =
      coarse_offset(times_of(taps, reference), foreign, setup.max_foreign_ci95_s, out.refusals);
  if (!offset) return;
  std::vector<Refusal> known;
  const auto their_taps = find_taps(foreign.signal, {kFewestTaps, foreign.name}, known);
  // Taps that occur in both recordings.
  std::vector<double> common;
  for (const double tap : taps)
    if (std::ranges::any_of(their_taps, [&](double t) { return std::abs(tap - t - *offset) < 0.01; }))
      common.push_back(tap);
  // On our time axis their signal is delayed by minus the offset.
  const auto delays = delays_of(
      reference, foreign.signal, common, [&](double) { return -*offset; }, foreign.name, out.refusals);
  std::vector<double> theirs, offsets;
  for (std::size_t i = 0; i < common.size(); ++i) {
    theirs.push_back(common[i] + delays.delay_s[i]);
    offsets.push_back(-delays.delay_s[i]);
  }
  if (const auto step = step_in_offsets(theirs, offsets, setup.max_foreign_ci95_s)) {
    out.refusals.push_back(refusal_of(*step, foreign.name));
    return;
  }
  const auto mean = mean_over_trials(theirs);
  std::vector<double> centred = theirs;
  for (auto& t : centred) t -= mean.value;
  const auto line = fit_line(centred, offsets, 1e-7);
  // A clock that is slewed (adjtime) runs at more than one rate, and one line is off by its residuals.
  const auto bend = curvature(centred, offsets);
  const bool bends = bend && std::abs(bend->t) > bend->t95 && line.largest_residual > kInterpolation_s;
  const double uneven_s = bends ? line.largest_residual : 0.0;
  const double ci95 = std::hypot(line.intercept_ci95, kInterpolation_s, uneven_s);
  if (bends)
    out.notes.push_back(
        fmt::format("{}: its clock does not run evenly: taps lie up to {:.3f} ms off one line, which "
                    "is in the interval; stop time synchronisation on that computer while it records",
                    foreign.name, 1e3 * uneven_s));
  clock = ForeignClock{line.intercept, ci95, line.slope, mean.value};
  Delays residuals{common, line.residual};
  out.sections.front().items.emplace_back(figure_of(residuals, TrialMean{}, foreign.name));
  out.notes.push_back(fmt::format("{}: t_recording = t {} {:.6f} s (+- {:.6f} s), its clock runs {:+.1f} ppm",
                                  foreign.name, line.intercept < 0.0 ? "-" : "+", std::abs(line.intercept),
                                  ci95, -1e6 * line.slope));
  double squares = 0.0;
  for (const double left : line.residual) squares += left * left;
  if (!line.residual.empty())
    out.residual_rms =
        std::max(out.residual_rms, std::sqrt(squares / static_cast<double>(line.residual.size())));
  if (ci95 > setup.max_foreign_ci95_s)
    out.refusals.push_back({"interval_too_wide",
                            fmt::format("the clock of {} is known to {:.3f} ms only, {:.3f} ms are asked for",
                                        foreign.name, 1e3 * ci95, 1e3 * setup.max_foreign_ci95_s),
                            "tap more often, and record faster there"});
}

}  // namespace

Outcome calibrate_timing(const Recording& taps, const LinuxBoardConfig& board, const TimingSetup& setup,
                         std::optional<ForeignClock>& clock) {
  Outcome out{.residual_unit = "s"};
  const auto reference = signal_of(taps, setup.reference);
  check_range(reference, board, setup.reference, out.refusals);
  const auto found = find_taps(reference, {kFewestTaps, name_of(setup.reference)}, out.refusals);
  out.points = found.size();
  if (!out.refusals.empty()) return out;
  out.sections = {{.title = "Delays"}};
  if (!setup.others.empty()) out.targets = {{ConfigFile::board, "timing", {}}};
  for (const auto sensor : setup.others) calibrate_sensor(taps, board, sensor, reference, found, setup, out);
  if (setup.foreign) calibrate_clock(reference, found, setup, clock, out);
  return out;
}

}  // namespace sandhopper::calibrate
