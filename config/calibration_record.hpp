#pragma once
#include <optional>
#include <string>
#include <vector>

#include "config/fields.hpp"

// Record that `hop calibrate` adds to the values it wrote: a table [calibration.NAME] at the end of the same
// file. Nothing is computed from it. It documents the origin of a value and reveals one that was edited
// since.
namespace sandhopper {

struct CalibrationRecord {
  std::string date;           // UTC, "2026-03-01 09:30:00"
  int points = 0;             // number of recordings or repeats in the fit
  double residual_rms = 0.0;  // rms residual of the fit
  std::string residual_unit;
  std::vector<std::string> keys;  // keys that were written
  std::vector<double> values;     // the value written to each key
  std::vector<double> ci95;       // half of the 95 % interval for each key; 0: exact, such as a sign

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("date", self.date);
    visit("points", self.points, Range{0, 1e9});
    visit("residual_rms", self.residual_rms, Range{0.0, 1e9});
    visit("residual_unit", self.residual_unit);
    visit("keys", self.keys);
    visit("values", self.values);
    visit("ci95", self.ci95, Range{0.0, 1e9});
  }

  template <class Problem>
  void check(Problem&& problem) const {
    if (values.size() != keys.size()) problem("values", "expected one value for each of the keys");
    if (ci95.size() != keys.size()) problem("ci95", "expected one half-width for each of the keys");
  }
};

// [calibration] of robot.toml and of the board's file. A missing table means that the calibration was never
// done.
struct RobotCalibrations {
  std::optional<CalibrationRecord> encoders{};
  std::optional<CalibrationRecord> torque_constant{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("encoders", self.encoders);
    visit("torque_constant", self.torque_constant);
  }
};

struct BoardCalibrations {
  std::optional<CalibrationRecord> imu_body{};
  std::optional<CalibrationRecord> imu_foot{};
  std::optional<CalibrationRecord> load_cell{};
  std::optional<CalibrationRecord> tof{};
  std::optional<CalibrationRecord> timing{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("imu_body", self.imu_body);
    visit("imu_foot", self.imu_foot);
    visit("load_cell", self.load_cell);
    visit("tof", self.tof);
    visit("timing", self.timing);
  }
};

}  // namespace sandhopper
