#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"

// Data of a trial's report, independent of their source.
namespace sandhopper {

// One channel with a value per row of ReportData::time_s; NaN: none in this row. Channels are named as in
// recordings (`estimate_foot_z_m`, `load_cell_force_N`, `truth_contact_force_N`, …). The page assigns
// channels to panels by name and leaves out panels without data.
struct ReportColumn {
  std::string name;
  std::vector<double> values;
};

// An event of the firmware.
struct ReportEvent {
  double time_s = 0.0;
  std::uint32_t stride = 0;
  std::string name;
  std::string reason;
  std::string values;  // values that triggered it, with units
};

// An interval in which the controller stays in one state.
struct ReportPhase {
  double from_s = 0.0;
  double to_s = 0.0;
  std::string name;
};

// Stiffness by one treatment, F = intercept + k z, with its 95 % interval.
struct ReportStiffness {
  double value_N_per_m = 0.0;
  double ci95_low_N_per_m = 0.0;
  double ci95_high_N_per_m = 0.0;
  double intercept_N = 0.0;
  std::int64_t samples = 0;
  bool valid = false;
  std::string reason;  // reason if not valid
  double standard_error_N_per_m = 0.0;
};

// A stride, with its stiffness by the treatments and the ground known after it.
struct ReportStride {
  std::uint32_t number = 0;
  double contact_s = 0.0;    // time at which the foot meets the ground
  double touchdown_s = 0.0;  // time at which the controller detects touchdown
  double switch_s = 0.0;
  double liftoff_s = 0.0;
  double touchdown_speed_mps = 0.0;
  double peak_force_N = 0.0;
  double max_depth_m = 0.0;     // below the surface at the first stride's contact
  double crater_depth_m = 0.0;  // deepest point of the earlier strides
  ReportStiffness quasi_static_ols{};
  ReportStiffness observer_ols{};
  ReportStiffness observer_wls{};
  ReportStiffness joint{};
  StrengthProfile profile{};  // of all strides up to this one; stride 0: the log has none
  GroundSummary ground{};
  GroundEvents ground_events{};  // of this stride; stride 0: the log has none
};

// Times are relative to the release, or to the first row if nothing was released.
struct ReportData {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  // label, text
  std::vector<std::string> notes;                          // important for the reader: faults, a cut log, …
  std::vector<double> time_s;                              // ascending
  std::vector<ReportColumn> columns;
  std::vector<ReportPhase> phases;
  std::vector<ReportEvent> events;
  std::vector<ReportStride> strides;
  std::string configuration;
  std::vector<double> bed_depth_m{};  // true force-depth curve of a simulated bed
  std::vector<double> bed_force_N{};
};

}  // namespace sandhopper
