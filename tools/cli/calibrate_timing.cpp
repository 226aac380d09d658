#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "firmware/log/csv_import.hpp"
#include "tools/calibrate/foreign_table.hpp"
#include "tools/calibrate/timing.hpp"
#include "tools/cli/calibration.hpp"
#include "tools/cli/failure.hpp"

namespace sandhopper::cli {
namespace {

using calibrate::TapSensor;

struct Options {
  std::string reference = "imu_foot";
  std::vector<std::string> sensors{"imu_body", "load_cell"};
  int taps = 10;
  std::string foreign;
  std::string foreign_column;
  std::string foreign_time_unit;
  std::string aligned;
};

TapSensor sensor_of(const std::string& name) {
  if (name == "imu_body") return TapSensor::imu_body;
  return name == "imu_foot" ? TapSensor::imu_foot : TapSensor::load_cell;
}

calibrate::ForeignTable read_foreign(const Options& options) {
  try {
    return calibrate::read_foreign_table(options.foreign, options.foreign_column, options.foreign_time_unit);
  } catch (const calibrate::ForeignTableError& error) {
    throw Failure(ExitCode::usage, error.what(), error.cure);
  }
}

// Writes the foreign table with its times converted to the recording's clock.
void write_aligned(const Options& options, const calibrate::ForeignClock& clock, double time_scale) {
  const auto table = read_csv(std::filesystem::path(options.foreign));
  std::ofstream out(options.aligned);
  for (std::size_t c = 0; c < table.names.size(); ++c) out << (c ? "," : "") << table.names[c];
  out << "\n";
  for (std::size_t i = 0; i < table.rows(); ++i) {
    for (std::size_t c = 0; c < table.names.size(); ++c) {
      const double value = table.columns[c][i];
      out << (c ? "," : "");
      const double t_s = value * time_scale;
      if (table.names[c] == "t_s")
        out << fmt::format("{:.6f}", t_s + clock.offset_s + clock.drift * (t_s - clock.middle_s));
      else if (!std::isnan(value))
        out << fmt::format("{}", value);
    }
    out << "\n";
  }
  if (!out.flush())
    throw Failure(ExitCode::fault, "cannot write " + options.aligned,
                  "name a file you may write with --aligned");
}

std::vector<calibrate::Step> steps(const Options& options) {
  if (options.foreign.empty() != options.foreign_column.empty())
    throw Failure(ExitCode::usage, "--foreign and --foreign-column belong together", "give both, or neither");
  if (!options.aligned.empty() && options.foreign.empty())
    throw Failure(ExitCode::usage, "--aligned needs --foreign",
                  "name the other computer's table with --foreign");
  calibrate::Step step;
  step.prompt = "stand the foot on something hard, the body held; let every recorder run";
  // Even taps may fit another computer's at several shifts.
  step.during = fmt::format(
      "tap along the leg {} times, {}, at once", options.taps,
      options.foreign.empty() ? "half a second apart" : "at uneven intervals of half a second and more");
  step.fixture.taps = options.taps;
  step.seconds = 0.5 * options.taps + 1.0;
  if (!options.foreign.empty()) read_foreign(options);  // reports an unusable table before the person taps
  if (options.foreign.empty()) step.seconds += 2.0;     // a person needs time to begin
  return {step};
}

calibrate::Outcome fit(const std::vector<calibrate::Recording>& recordings, const CalibrationInput& input,
                       const Options& options) {
  calibrate::TimingSetup setup;
  setup.reference = sensor_of(options.reference);
  for (const auto& name : options.sensors)
    if (name != options.reference) setup.others.push_back(sensor_of(name));
  std::vector<std::string> notes;
  double time_scale = 1.0;
  if (!options.foreign.empty()) {
    setup.others.clear();
    auto table = read_foreign(options);
    time_scale = table.time_scale;
    setup.foreign = std::move(table.recording);
    notes = std::move(table.notes);
  }
  std::optional<calibrate::ForeignClock> clock;
  auto outcome = calibrate_timing(recordings.front(), input.board, setup, clock);
  outcome.notes.insert(outcome.notes.begin(), notes.begin(), notes.end());
  if (clock && outcome.refusals.empty() && !options.aligned.empty()) {
    write_aligned(options, *clock, time_scale);
    outcome.notes.push_back(options.aligned + " has its rows with times of the recording");
  }
  return outcome;
}

Calibration::Actions set_up(Arguments& arguments) {
  auto options = std::make_shared<Options>();
  const std::vector<std::string> sensors{"imu_body", "imu_foot", "load_cell"};
  arguments.add_option("--reference", options->reference, "sensor whose time stamps are right")
      .one_of(sensors)
      .show_default();
  arguments.add_option("--sensors", options->sensors, "whose latency is found")
      .separated_by(',')
      .one_of(sensors)
      .show_default();
  arguments.add_option("--taps", options->taps, "how many").in_range(5, 200).show_default();
  arguments
      .add_option(
          "--foreign", options->foreign,
          "table (.csv) of another computer with the same taps: its clock is found in place of latencies")
      .existing_file();
  arguments.add_option("--foreign-column", options->foreign_column, "of that table, where the taps show");
  arguments
      .add_option("--foreign-time-unit", options->foreign_time_unit,
                  "unit of that table's t_s; default: that of its line of units, else s")
      .one_of({"s", "ms", "us", "ns", "min"});
  arguments.add_option("--aligned", options->aligned, "writes that table with times of the recording (t_s)");
  return {.steps = [options](const CalibrationInput&) { return steps(*options); },
          .fit = [options](const auto& recordings,
                           const auto& input) { return fit(recordings, input, *options); }};
}

const CalibrationRegistration kTiming(
    {"timing", "skew between sensors, and of another computer's clock, from taps that all of them feel",
     set_up});

}  // namespace
}  // namespace sandhopper::cli
