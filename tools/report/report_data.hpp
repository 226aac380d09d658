#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"

// What a trial's report shows, whatever it was read from.
namespace sandhopper {

// One channel, a value per row of ReportData::time_s; NaN where the row has none. Names are those of the
// recordings (`estimate_foot_z_m`, `load_cell_force_N`, `truth_contact_force_N`, …): the page knows which
// panel shows which, and leaves out what is not there.
struct ReportColumn {
  std::string name;
  std::vector<double> values;
};

struct ReportEvent {
  double time_s = 0.0;
  std::uint32_t stride = 0;
  std::string name;
  std::string reason;
  std::string values;  // what triggered it, with units
};

// A stretch of time in one state of the controller.
struct ReportPhase {
  double from_s = 0.0;
  double to_s = 0.0;
  std::string name;
};

struct ReportStiffness {
  double value_N_per_m = 0.0;
  double ci95_low_N_per_m = 0.0;
  double ci95_high_N_per_m = 0.0;
  double intercept_N = 0.0;
  std::int64_t samples = 0;
  bool valid = false;
  std::string reason;  // why not valid
  double standard_error_N_per_m = 0.0;
};

struct ReportStride {
  std::uint32_t number = 0;
  double contact_s = 0.0;    // the foot meets the ground
  double touchdown_s = 0.0;  // the controller notices
  double switch_s = 0.0;
  double liftoff_s = 0.0;
  double touchdown_speed_mps = 0.0;
  double peak_force_N = 0.0;
  double max_depth_m = 0.0;     // below where the first stride met the surface
  double crater_depth_m = 0.0;  // deepest point of the strides before
  ReportStiffness quasi_static_ols{};
  ReportStiffness observer_ols{};
  ReportStiffness observer_wls{};
  ReportStiffness joint{};
  StrengthProfile profile{};  // of all strides up to this one; stride 0 where the log has none
  GroundSummary ground{};
  GroundEvents ground_events{};  // of this stride; stride 0 where the log has none
};

// Times are relative to the release, or to the first row where nothing was released.
struct ReportData {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // label, text
  std::vector<std::string> notes;  // what the reader must know: faults, a cut log, …
  std::vector<double> time_s;      // ascending
  std::vector<ReportColumn> columns;
  std::vector<ReportPhase> phases;
  std::vector<ReportEvent> events;
  std::vector<ReportStride> strides;
  std::string configuration;
  std::vector<double> bed_depth_m{};  // true curve of a simulated bed
  std::vector<double> bed_force_N{};
};

}  // namespace sandhopper
