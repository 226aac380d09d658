#include "tools/experiment/paper/summaries.hpp"

#include <cmath>

#include "tools/experiment/statistics.hpp"

namespace sandhopper::paper {

std::vector<const HopResult*> complete_trials(const ProgrammeResults& results,
                                              const std::function<bool(const HopCell&)>& wanted) {
  std::vector<const HopResult*> trials;
  for (const auto& hop : results.hops)
    if (hop.complete && (!wanted || wanted(hop_cells()[hop.cell]))) trials.push_back(&hop);
  return trials;
}

EstimationErrors errors_of_all(const ProgrammeResults& results) {
  EstimationErrors errors;
  for (const auto* trial : complete_trials(results)) errors.add(trial->errors);
  return errors;
}

std::vector<double> over(const std::vector<const HopResult*>& trials,
                         const std::function<double(const HopResult&)>& feature) {
  std::vector<double> values;
  for (const auto* trial : trials)
    if (const double value = feature(*trial); std::isfinite(value)) values.push_back(value);
  return values;
}

double share_of(const std::vector<const HopResult*>& trials,
                const std::function<bool(const HopResult&)>& holds) {
  double count = 0.0;
  for (const auto* trial : trials) count += holds(*trial) ? 1.0 : 0.0;
  return count / static_cast<double>(trials.size());
}

namespace {

// Touchdown speeds of the hop set, each once.
std::vector<double> touchdown_speeds_mps() {
  std::vector<double> speeds;
  for (const auto& cell : hop_cells())
    if (speeds.empty() || speeds.back() != cell.touchdown_speed_mps)
      speeds.push_back(cell.touchdown_speed_mps);
  return speeds;
}

std::vector<const HopResult*> trials_at(const ProgrammeResults& results, double speed_mps) {
  return complete_trials(results,
                         [speed_mps](const HopCell& cell) { return cell.touchdown_speed_mps == speed_mps; });
}

}  // namespace

std::vector<SpeedDecomposition> decomposition_by_speed(const ProgrammeResults& results,
                                                       Decomposition HopResult::*source) {
  std::vector<SpeedDecomposition> rows;
  for (const double speed_mps : touchdown_speeds_mps()) {
    const auto trials = trials_at(results, speed_mps);
    const auto average = [&](double Decomposition::*feature) {
      return mean(over(trials, [&](const HopResult& h) {
        const auto& decomposition = h.*source;
        return decomposition.known ? decomposition.*feature : std::nan("");
      }));
    };
    rows.push_back({.speed_mps = speed_mps,
                    .line_N = average(&Decomposition::line_rms_N),
                    .map_N = average(&Decomposition::map_rms_N),
                    .inertial_N = average(&Decomposition::inertial_rms_N),
                    .correlation = average(&Decomposition::correlation)});
  }
  return rows;
}

std::vector<SpeedErrors> errors_by_speed(const ProgrammeResults& results) {
  std::vector<SpeedErrors> rows;
  for (const double speed_mps : touchdown_speeds_mps()) {
    SpeedErrors row{speed_mps, {}};
    for (const auto* trial : trials_at(results, speed_mps)) row.errors.add(trial->errors);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace sandhopper::paper
