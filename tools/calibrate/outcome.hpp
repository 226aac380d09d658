#pragma once
#include <string>
#include <vector>

#include "tools/calibrate/still.hpp"
#include "tools/report/study.hpp"

namespace sandhopper::calibrate {

// One key of the configuration with its new value.
struct CalibratedValue {
  std::string key{};   // for example "load_cell.scale_N_per_V"
  std::string unit{};  // "N/V"
  double before = 0.0;
  double after = 0.0;
  double ci95 = 0.0;   // half of the 95 % interval; 0: exact, for example a sign
  bool whole = false;  // true: an integer key
};

// robot.toml or the board's file.
enum class ConfigFile { robot, board };

// Result of a calibration. It is written to the files only if `refusals` is empty.
struct Outcome {
  struct Target {
    ConfigFile file;
    std::string table;  // "load_cell": the record is written to [calibration.load_cell]
    std::vector<CalibratedValue> values;
  };
  std::vector<Target> targets{};
  std::size_t points = 0;
  double residual_rms = 0.0;
  std::string residual_unit{};
  std::vector<Refusal> refusals{};
  std::vector<std::string> notes{};  // for the user; no reason to refuse
  std::vector<StudySection> sections{};
};

}  // namespace sandhopper::calibrate
