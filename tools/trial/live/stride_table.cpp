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

constexpr int kGroundColumn = 8;

std::vector<std::string> ground_lines(const TrialModel& model, int columns) {
  if (model.known_ground.empty()) return {};
  return wrap(model.known_ground, columns - kGroundColumn, 0);
}

}  // namespace

int ground_rows(const TrialModel& model, int columns) {
  return static_cast<int>(ground_lines(model, columns).size());
}

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
  constexpr std::string_view kTitle = "ground";
  const auto lines = ground_lines(model, pane.columns());
  for (std::size_t i = 0; i < lines.size() && pane.line(); ++i) {
    if (i == 0) pane.put(1, kTitle, Style::bold);
    pane.put(kGroundColumn, lines[i]);
  }
}

}  // namespace sandhopper
