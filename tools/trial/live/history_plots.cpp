#include "tools/trial/live/history_plots.hpp"

#include <algorithm>
#include <limits>

#include "tools/trial/live/braille_plot.hpp"

namespace sandhopper {
namespace {

constexpr double kBefore_s = 0.3;
constexpr double kShortest_s = 4.0;
constexpr double kAfter_s = 0.5;

struct Times {
  std::int64_t origin_ns;
  double from_s, to_s;
};

// Time range from the release to rest; later samples do not move it off the screen.
Times times_of(const TrialModel& model) {
  const auto now_ns = model.history.empty() ? 0 : model.history.back().time_ns;
  if (!model.released_ns) return {now_ns, -kShortest_s, 0.0};
  auto end_ns = now_ns;
  for (const auto& s : model.history)
    if (s.time_ns > *model.released_ns && s.drives_on) end_ns = s.time_ns;
  const double end_s = static_cast<double>(end_ns - *model.released_ns) * 1e-9;
  return {*model.released_ns, -kBefore_s, std::max(kShortest_s, end_s + kAfter_s)};
}

}  // namespace

void draw_history(Canvas& canvas, Pane::Area area, const TrialModel& model) {
  const auto [origin_ns, from_s, to_s] = times_of(model);
  std::vector<PlotPoint> length, force;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const auto& s : model.history) {
    const double time_s = static_cast<double>(s.time_ns - origin_ns) * 1e-9;
    if (time_s < from_s || time_s > to_s) continue;
    length.push_back({time_s, s.estimating ? 1e3 * s.leg_length_m : kNone});
    force.push_back({time_s, s.estimating ? s.bed_force_N : kNone});
  }
  const double extended_mm = 1e3 * model.config.controller.extension_length_m;
  const int half = area.rows / 2;
  draw_plot(Pane(canvas, {area.row, area.column, half, area.columns}),
            {"Bed force, N", from_s, to_s, 0.0, 40.0}, force);
  draw_plot(Pane(canvas, {area.row + half, area.column, area.rows - half, area.columns}),
            {"Leg length, mm", from_s, to_s, 0.6 * extended_mm, extended_mm}, length);
}

}  // namespace sandhopper
