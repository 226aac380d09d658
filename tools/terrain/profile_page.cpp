#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/profile_text.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kNamedCurves = 15;  // as many styles tell_apart() has; more curves share an entry
constexpr std::size_t kDrawnCurves = 40;  // more curves would hide one another

StudySeries line_of(const StrengthCurve& curve) {
  StudySeries series{.mark = StudySeries::Mark::line};
  for (std::size_t i = 0; i < curve.force_N.size(); ++i) {
    const double depth_m = static_cast<double>(i + 1) * 0.5 * curve.cell_m;
    if (depth_m < curve.from_m || depth_m > curve.to_m) continue;
    series.x.push_back(1e3 * depth_m);
    series.y.push_back(curve.force_N[i]);
  }
  return series;
}

// Band of a group. With only two of several trials left the band would fill the figure, so it ends where
// fewer than three are left, unless there were never more than two.
StudySeries band(std::string label, std::span<const PooledDepth> depths, const std::string& color,
                 bool further) {
  std::size_t most = 0;
  for (const auto& p : depths) most = std::max(most, p.force_N.trials);
  StudySeries series{.label = std::move(label),
                     .mark = StudySeries::Mark::band,
                     .color = color,
                     .shade = further ? 0.5 : 0.0};
  for (const auto& p : depths) {
    if (!std::isfinite(p.force_N.new_high) || (p.force_N.trials < 3 && most > 2)) continue;
    series.x.push_back(1e3 * p.depth_m);
    series.y.push_back(p.force_N.value);
    series.low.push_back(further ? p.force_N.new_low : p.force_N.mean_low);
    series.high.push_back(further ? p.force_N.new_high : p.force_N.mean_high);
  }
  return series;
}

// Adds few trials by name, each in its own style. Many are divided, in their order, into five runs of trials,
// each with a colour, so that a drift from trial to trial is seen.
void add_curves(std::span<const StrengthCurve> curves, const std::string& label, StudyFigure& figure) {
  const std::size_t drawn = std::min(curves.size(), kDrawnCurves);
  if (drawn == 0) return;
  if (drawn <= kNamedCurves) {
    for (std::size_t i = 0; i < drawn; ++i) {
      auto series = line_of(curves[i]);
      series.label = trial_label(curves[i].trial) + (curves[i].held_out ? " (held out)" : "");
      tell_apart(series, i);
      figure.series.push_back(std::move(series));
    }
    return;
  }
  constexpr std::size_t kRuns = 5;
  for (std::size_t run = 0; run < kRuns; ++run) {
    const std::size_t first = run * drawn / kRuns, end = (run + 1) * drawn / kRuns;
    auto all = line_of(curves[first]);
    for (std::size_t i = first + 1; i < end; ++i) {
      const auto next = line_of(curves[i]);
      all.x.push_back(NAN);
      all.y.push_back(NAN);
      all.x.insert(all.x.end(), next.x.begin(), next.x.end());
      all.y.insert(all.y.end(), next.y.begin(), next.y.end());
    }
    all.label = fmt::format("{} {} to {}", label, trial_label(curves[first].trial),
                            trial_label(curves[end - 1].trial));
    tell_apart(all, run);
    figure.series.push_back(std::move(all));
  }
}

StudyFigure group_figure(const CurveGroup& group) {
  StudyFigure figure{.title = "Force against depth: " + group_title(group),
                     .x_label = "depth, mm",
                     .y_label = "force of the ground, N",
                     .wide = true};
  if (group.curves.size() > 1) {
    figure.series.push_back(band("one new trial, 95 %", group.depths, "text", true));
    figure.series.push_back(band("mean of the ground, 95 %", group.depths, "text", false));
  }
  add_curves(group.curves, "trials", figure);
  const double all_m = group.deepest_all_m();
  if (!group.depths.empty() && group.depths.back().depth_m > all_m + group.curves.front().cell_m)
    figure.marks.push_back({1e3 * all_m, "all trials to here"});
  figure.note =
      "Dark band: 95 % interval of the mean over places of this ground; the line in it is the mean. Light "
      "band: one new trial lies in it, with 95 %. Both hold at each depth by itself, and are drawn where at "
      "least "
      "three trials reached (with two trials, where both did).";
  if (group.curves.size() > kDrawnCurves)
    figure.note += fmt::format(" The first {} of {} trials are drawn.", kDrawnCurves, group.curves.size());
  if (!figure.marks.empty())
    figure.note += " Deeper than the dotted line only some trials are left, perhaps those on weaker ground.";
  return figure;
}

StudyTable group_table(const CurveGroup& group) {
  StudyTable table{
      .title = "Strength at round depths",
      .columns = {"depth, mm", "trials", "force, N", "one new trial, N", "secant, N/m", "tangent, N/m",
                  "sd of force between trials, N"},
      .text_columns = 0,
      .note =
          "Mean over trials and, in brackets, its 95 % interval. One new trial: 95 % interval of the "
          "next trial's force. Secant: force over depth. Tangent: slope of the curve at that "
          "depth. sd: standard deviation. –: one trial gives no interval."};
  for (const double depth_m : listed_depths_m(group)) {
    const auto& p = *group.at(depth_m);
    table.rows.push_back(
        {short_number(1e3 * depth_m), fmt::format("{}", p.force_N.trials), pooled_text(p.force_N),
         new_trial_text(p.force_N), pooled_text(p.force_N, 1.0 / p.depth_m), pooled_text(p.tangent_N_per_m),
         p.force_N.trials > 1 ? value_text(p.force_N.between_sd, 0.0, 2.0 * p.force_N.between_sd) : "–"});
  }
  return table;
}

StudyFigure prediction_figure(const ProfilePrediction& p, std::span<const StrengthCurve> held_out) {
  StudyFigure figure{
      .title = fmt::format("Held out: {} mm predicted from {} mm, {}", short_number(1e3 * p.diameter_m),
                           short_number(1e3 * p.from_diameter_m), p.law),
      .x_label = "depth, mm",
      .y_label = "force of the ground, N"};
  figure.series.push_back(band("one new trial, 95 %", p.band, "text", true));
  figure.series.push_back(band("mean of the ground, 95 %", p.band, "text", false));
  std::vector<StrengthCurve> curves;
  for (const auto& curve : held_out)
    if (curve.source == p.source && curve.diameter_m == p.diameter_m) curves.push_back(curve);
  add_curves(curves, "trials held out", figure);
  figure.note = prediction_text(p);
  return figure;
}

StudySection section_of(const ProfileConclusion& conclusion) {
  StudySection section{.title = "Strength of the ground over depth"};
  section.items.emplace_back(std::string(
      "The force over depth is estimated from each trial by itself, as the firmware does after a "
      "stride. Then the trials are pooled at every depth. Intervals come from how much the trials differ."));
  for (const auto& group : conclusion.groups) {
    if (group.depths.empty()) {
      section.items.emplace_back(group_title(group) + ". " + bound_text(group));
      continue;
    }
    section.items.emplace_back(group_figure(group));
    std::string numbers = numbers_text(group);
    if (!numbers.empty()) {
      numbers.front() = static_cast<char>(std::toupper(numbers.front()));
      section.items.emplace_back(numbers + ". " + shapes_text(group) + " " + left_out_text(group));
    }
    section.items.emplace_back(group_table(group));
  }
  for (const auto& prediction : conclusion.predictions)
    section.items.emplace_back(prediction_figure(prediction, conclusion.held_out));
  for (const auto& note : conclusion.notes) section.items.emplace_back(note);
  return section;
}

}  // namespace

CampaignConclusions tell_profile(const ProfileConclusion& conclusion) {
  CampaignConclusions out;
  out.answer = profile_answer(conclusion.groups.front());
  out.lines = profile_lines(conclusion);
  out.json = profile_json(conclusion);
  out.tables.push_back({"profile", profile_csv(conclusion)});
  out.sections.push_back(section_of(conclusion));
  return out;
}

}  // namespace sandhopper
