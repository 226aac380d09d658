#include "tools/campaign/force_at_depth.hpp"

#include <cmath>

#include "firmware/log/csv_import.hpp"
#include "tools/campaign/trial_rows.hpp"

namespace sandhopper {
namespace {

// The channel's values, and between two samples those on the line through them.
std::vector<double> filled(const std::vector<double>& values, const std::vector<double>& t_s) {
  std::vector<std::size_t> fresh;
  std::vector<double> times_s;
  for (std::size_t row = 0; row < values.size(); ++row)
    if (!std::isnan(values[row])) fresh.push_back(row), times_s.push_back(t_s[row]);
  std::vector<double> out = values;
  if (fresh.size() < 2) return out;
  const double longest_s = kLongestStep * median_step_s(times_s);
  for (std::size_t i = 1; i < fresh.size(); ++i) {
    const std::size_t before = fresh[i - 1], after = fresh[i];
    const double step_s = t_s[after] - t_s[before];
    if (!(step_s > 0.0) || step_s > longest_s) continue;
    for (std::size_t row = before + 1; row < after; ++row)
      out[row] = std::lerp(values[before], values[after], (t_s[row] - t_s[before]) / step_s);
  }
  return out;
}

}  // namespace

ForceAtDepth::ForceAtDepth(const TrialRecording& recording) {
  const auto* heights = recording.find("foot_z_m");
  const auto* forces = recording.find("force_N");
  if (heights == nullptr || forces == nullptr || recording.t_s.size() != heights->size()) return;
  const auto z = filled(*heights, recording.t_s);
  for (std::size_t row = 0; row < z.size(); ++row) {
    if (std::isnan(z[row]) || std::isnan((*forces)[row])) continue;
    rows.push_back(row), t_s.push_back(recording.t_s[row]);
    z_m.push_back(z[row]), force_N.push_back((*forces)[row]);
  }
}

}  // namespace sandhopper
