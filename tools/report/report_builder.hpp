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

// Turns a trial's records, in order of time, into the data of the page: one row per cycle. A sensor's sample
// and the forces stand in the row nearest to their instant of measurement, not in the row of the cycle that
// received them. Curves of measurements with different delays then line up.
class ReportBuilder {
 public:
  void add(const SensorFrame& frame);
  void add(const StepOutput& output);
  void add(const PlantTruth& truth);
  void add(const Event& event);
  void add(const StrideResult& stride);
  void add(const StrengthProfile& profile);  // call it after the stride that the profile ends with
  void add(const GroundSummary& ground);
  void add(const GroundEvents& found);

  // Data of the records added so far. The caller adds title, facts, configuration, and all notes but those on
  // faults.
  ReportData data() const;
  // Sets the configuration that the log carries. It gives the limits of faults.
  void set_robot(ConfigNode robot) { robot_ = std::move(robot); }

 private:
  struct Point {
    std::size_t channel;
    std::int64_t time_ns;
    double value;
  };
  void put(std::size_t channel, std::int64_t time_ns, double value);
  double seconds(std::int64_t time_ns) const;  // NaN if time_ns is 0: the event did not happen
  double depth_datum_m() const;
  void add_columns(ReportData& data) const;
  void add_phases(ReportData& data) const;

  std::optional<ConfigNode> robot_{};
  std::vector<std::int64_t> row_ns_;  // times of the cycles
  std::vector<State> state_;
  std::vector<Point> points_;
  std::vector<Event> events_;
  std::vector<StrideResult> strides_;
  std::vector<StrengthProfile> profiles_;  // one per stride, like grounds_ and ground_events_
  std::vector<GroundSummary> grounds_;
  std::vector<GroundEvents> ground_events_;
  std::int64_t zero_ns_ = 0;
  bool released_ = false;
  std::int64_t newest_force_ns_ = 0;
  std::int64_t fresh_load_cell_ns_ = 0;  // 0: no fresh sample in the newest frame
  std::int64_t newest_mocap_ns_ = 0;
};

}  // namespace sandhopper
