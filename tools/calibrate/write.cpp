#include "tools/calibrate/write.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/dump.hpp"
#include "config/edit.hpp"
#include "config/load.hpp"
#include "config/robot_config.hpp"
#include "firmware/linux_board_config.hpp"

namespace sandhopper::calibrate {
namespace {

int decimals_of(const CalibratedValue& value) {
  const double unit = value.ci95 > 0.0 ? value.ci95 : std::abs(value.after) * 1e-3;
  return unit > 0.0 ? std::clamp(2 - static_cast<int>(std::floor(std::log10(unit))), 1, 12) : 6;
}

// Rounds to three significant digits: an interval or a residual has no more.
double rounded(double value) { return std::stod(fmt::format("{:.3g}", value)); }

CalibrationRecord record_of(const Outcome& outcome, const Outcome::Target& target, const std::string& date) {
  CalibrationRecord record;
  record.date = date;
  record.points = static_cast<int>(outcome.points);
  record.residual_rms = rounded(outcome.residual_rms);
  record.residual_unit = outcome.residual_unit;
  for (const auto& value : target.values) {
    record.keys.push_back(value.key);
    record.values.push_back(std::stod(value_text(value)));
    record.ci95.push_back(rounded(value.ci95));
  }
  return record;
}

}  // namespace

std::string value_text(const CalibratedValue& value) {
  return value.whole ? fmt::format("{:.0f}", value.after)
                     : fmt::format("{:.{}f}", value.after, decimals_of(value));
}

std::string with_calibration(const std::string& file_name, const std::string& text, const Outcome& outcome,
                             const Outcome::Target& target, const std::string& date) {
  ConfigEditor editor(file_name, text);
  for (const auto& value : target.values) editor.set(value.key, value_text(value));
  editor.set_table("calibration." + target.table,
                   "Written by `hop calibrate`: where the values named here come from.",
                   to_toml(to_node(record_of(outcome, target, date))));
  if (target.file == ConfigFile::robot)
    load_text<RobotConfig>(file_name, editor.text());
  else
    load_text<LinuxBoardConfig>(file_name, editor.text());
  return editor.text();
}

}  // namespace sandhopper::calibrate
