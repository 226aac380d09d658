#include "tools/trial/live/stride_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sandhopper {
namespace {

std::string stiffness_text(const LiveStride::Stiffness& k) {
  if (!k.valid) return fmt::format("none: {}", k.reason);
  return fmt::format("{:6.0f}  [{:6.0f}, {:6.0f}] N/m", k.value_N_per_m, k.low_N_per_m, k.high_N_per_m);
}

}  // namespace

void draw_strides(Pane& pane, const TrialModel& model, int most) {
  pane.heading(fmt::format("Strides, {} of {}", model.strides.size(), model.config.limits.strides));
  pane.line();
  pane.put(1, " #  touchdown   depth    peak     stiffness with its 95 % interval", Style::faint);
  const auto count = static_cast<std::ptrdiff_t>(model.strides.size());
  const auto first = model.strides.begin() + std::max<std::ptrdiff_t>(0, count - most);
  for (auto s = first; s != model.strides.end(); ++s) {
    pane.line();
    pane.put(1, fmt::format("{:2}  {:5.2f} m/s  {:5.1f} mm  {:5.1f} N   ", s->number, s->touchdown_speed_mps,
                            1e3 * s->max_depth_m, s->peak_force_N));
    const bool last = std::next(s) == model.strides.end();
    const bool line = s->joint.valid && s->ground.empty();
    pane.put(38, s->ground.empty() ? stiffness_text(s->joint) : s->ground,
             !line  ? Style::faint
             : last ? Style::good
                    : Style::plain);
  }
  for (auto i = std::min<std::ptrdiff_t>(count, most); i < std::min(most, model.config.limits.strides); ++i) {
    pane.line();
    pane.put(1, fmt::format("{:2}", i + 1), Style::faint);
    pane.put(5, "–", Style::faint);
  }
}

}  // namespace sandhopper
