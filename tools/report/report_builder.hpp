#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/node.hpp"
#include "firmware/event.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"
#include "tools/plant/plant_truth.hpp"
#include "tools/report/report_data.hpp"

namespace sandhopper {

// Turns a trial's records, in the order of their times, into what the page shows: one row per cycle. What a
// sensor measured stands in the row nearest to the instant of measurement, not in that of the cycle that
// heard of it, and so do the forces: curves of different ages then lie over each other.
class ReportBuilder {
 public:
  void add(const SensorFrame& frame);
  void add(const StepOutput& output);
  void add(const PlantTruth& truth);
  void add(const Event& event);
  void add(const StrideResult& stride);
  void add(const StrengthProfile& profile);  // after the stride that it ends with
  void add(const GroundSummary& ground);
  void add(const GroundEvents& found);

  // The records so far; title, facts, notes beyond faults, and configuration are the caller's.
  ReportData data() const;
  // The configuration that the log carries, which gives the limits of faults.
  void set_robot(ConfigNode robot) { robot_ = std::move(robot); }

 private:
  struct Point {
    std::size_t channel;
    std::int64_t time_ns;
    double value;
  };
  void put(std::size_t channel, std::int64_t time_ns, double value);
  double seconds(std::int64_t time_ns) const;  // NaN for 0: it did not happen
  double depth_datum_m() const;
  void add_columns(ReportData& data) const;
  void add_phases(ReportData& data) const;

  std::optional<ConfigNode> robot_{};
  std::vector<std::int64_t> row_ns_;  // of the cycles
  std::vector<State> state_;
  std::vector<Point> points_;
  std::vector<Event> events_;
  std::vector<StrideResult> strides_;
  std::vector<StrengthProfile> profiles_;  // as many
  std::vector<GroundSummary> grounds_;
  std::vector<GroundEvents> ground_events_;
  std::int64_t zero_ns_ = 0;
  bool released_ = false;
  std::int64_t newest_force_ns_ = 0;
  std::int64_t fresh_load_cell_ns_ = 0;  // 0: none in the newest frame
  std::int64_t newest_mocap_ns_ = 0;
};

}  // namespace sandhopper
