#include "tools/terrain/profile_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tools/report/digits.hpp"
#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/mean_json.hpp"
#include "tools/terrain/rigid_ground.hpp"

namespace sandhopper {

std::string short_number(double value) {
  if (!std::isfinite(value)) return "–";
  return std::abs(value) >= 1000.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

namespace {

using Json = nlohmann::ordered_json;

std::string_view source_text(CurveSource source) {
  switch (source) {
    case CurveSource::firmware:
      return "hops, firmware's own estimate";
    case CurveSource::load_cell:
      return "hops, load cell and motion capture";
    case CurveSource::rig:
      return "plates pressed or driven in";
    case CurveSource::drop:
      return "drops";
  }
  return "";
}

std::string_view foot_word(CurveSource source) {
  if (source == CurveSource::rig) return "plate";
  return source == CurveSource::drop ? "body" : "foot";
}

std::string trials_text(std::size_t trials) {
  return fmt::format("{} trial{}", trials, trials == 1 ? "" : "s");
}

// To two digits of half the interval.
std::string in_interval(double value, double low, double high) {
  return digits_by(value, 0.5 * (high - low)).value_or(short_number(value));
}

std::string limits(double low, double high, double scale) {
  if (!std::isfinite(low) || !std::isfinite(high)) return "–";
  return fmt::format("[{}, {}]", in_interval(scale * low, scale * low, scale * high),
                     in_interval(scale * high, scale * low, scale * high));
}

std::string mm_text(double depth_m) {
  return depth_m < 0.001 ? fmt::format("{:.1f}", 1e3 * depth_m) : fmt::format("{:.3g}", 1e3 * depth_m);
}

Json value_json(const PooledValue& v, double scale = 1.0) {
  return {{"value", number_or_null(scale * v.value)},
          {"ci95_of_the_mean", {number_or_null(scale * v.mean_low), number_or_null(scale * v.mean_high)}},
          {"ci95_of_one_new_trial", {number_or_null(scale * v.new_low), number_or_null(scale * v.new_high)}},
          {"sd_between_trials", v.trials > 1 ? number_or_null(scale * v.between_sd) : Json(nullptr)},
          {"trials", v.trials}};
}

Json in_band_json(const std::vector<CurveInBand>& trials) {
  Json list = Json::array();
  for (const auto& t : trials)
    list.push_back({{"trial", t.trial},
                    {"depths", t.depths},
                    {"inside", t.inside},
                    {"force_over_middle", number_or_null(t.force_ratio)},
                    {"half_width_over_middle", number_or_null(t.half_width)}});
  return list;
}

// Number of depths of all trials that lie inside the band, and number of all depths.
std::pair<std::size_t, std::size_t> inside_of(const std::vector<CurveInBand>& trials) {
  std::size_t inside = 0, depths = 0;
  for (const auto& t : trials) {
    inside += t.inside;
    depths += t.depths;
  }
  return {inside, depths};
}

double share_of(const std::vector<CurveInBand>& trials) {
  const auto [inside, depths] = inside_of(trials);
  return depths > 0 ? static_cast<double>(inside) / static_cast<double>(depths) : 0.0;
}

// Width of the band. A wide band contains every curve, so the share inside is given with the width.
std::string width_text(const std::vector<CurveInBand>& trials) {
  double width = 0.0;
  for (const auto& t : trials) width += t.half_width / static_cast<double>(trials.size());
  return fmt::format("that band is ±{:.0f} % wide on average", 100.0 * width);
}

std::string inside_text(const std::vector<CurveInBand>& trials) {
  const auto [inside, depths] = inside_of(trials);
  std::vector<std::string> shares;
  for (const auto& t : trials)
    if (shares.size() < 6) shares.push_back(fmt::format("{:.0f}", 100.0 * t.share()));
  const std::string_view more = trials.size() > shares.size() ? ", …" : "";
  return fmt::format("{} of {} depths ({:.0f} %; by trial {}{} %)", inside, depths, 100.0 * share_of(trials),
                     fmt::join(shares, ", "), more);
}

std::string table_line(const PooledDepth& p) {
  const double z = p.depth_m;
  return fmt::format("  {:>6} mm  {:>24} N  {:>16} N  {:>22} N/m  {:>3}", mm_text(z), pooled_text(p.force_N),
                     new_trial_text(p.force_N), pooled_text(p.force_N, 1.0 / z), p.force_N.trials);
}

}  // namespace

std::string group_title(const CurveGroup& group) {
  return fmt::format("{}, {} of {} mm, {}", source_text(group.source), foot_word(group.source),
                     mm_text(group.diameter_m), trials_text(group.curves.size()));
}

std::vector<double> listed_depths_m(const CurveGroup& group) {
  std::vector<double> listed;
  if (group.depths.empty()) return listed;
  constexpr std::array kSteps_m{0.001, 0.002, 0.005, 0.010, 0.020, 0.050, 0.100, 0.200, 0.500, 1.0};
  constexpr double kMost = 8.0;
  const double deepest_m = group.depths.back().depth_m;
  double step_m = kSteps_m.back();
  for (const double candidate_m : kSteps_m)
    if (deepest_m / candidate_m <= kMost) step_m = std::min(step_m, candidate_m);
  for (double depth_m = step_m; depth_m <= deepest_m + 1e-9; depth_m += step_m)
    if (group.at(depth_m) != nullptr) listed.push_back(depth_m);
  return listed;
}

std::string pooled_text(const PooledValue& v, double scale) {
  if (std::isnan(v.value)) return "–";
  const auto value = in_interval(scale * v.value, scale * v.mean_low, scale * v.mean_high);
  if (!std::isfinite(v.mean_low) || !std::isfinite(v.mean_high)) return value;  // one trial has no interval
  return value + " " + limits(v.mean_low, v.mean_high, scale);
}

std::string new_trial_text(const PooledValue& v, double scale) {
  if (std::isnan(v.value)) return "–";
  return limits(v.new_low, v.new_high, scale);
}

std::string numbers_text(const CurveGroup& g) {
  std::vector<std::string> parts;
  if (g.slope_N_per_m.trials > 0)
    parts.push_back(fmt::format("slope from {} to {} mm: {} N/m", mm_text(g.slope_from_m),
                                mm_text(g.slope_to_m), pooled_text(g.slope_N_per_m)));
  if (g.secant_20mm_N_per_m.trials > 0)
    parts.push_back(fmt::format("secant at 20 mm: {} N/m", pooled_text(g.secant_20mm_N_per_m)));
  if (g.exponent.trials > 0)
    parts.push_back(fmt::format("exponent of a power law: {}", pooled_text(g.exponent)));
  return fmt::format("{}", fmt::join(parts, "; "));
}

std::string shapes_text(const CurveGroup& g) {
  std::map<GroundShape, std::size_t> counts;
  for (const auto& curve : g.curves) ++counts[curve.shape];
  std::vector<std::string> parts;
  constexpr std::array<const char*, 6> kTexts{"too little ground",   "a line", "a power law",
                                              "a line with a crust", "layers", "none of these"};
  for (const auto& [shape, count] : counts)
    parts.push_back(fmt::format("{} in {}", kTexts[static_cast<std::size_t>(shape)], count));
  return fmt::format("Simplest shape that each trial allows: {}.", fmt::join(parts, ", "));
}

std::string left_out_text(const CurveGroup& g) {
  if (g.left_out.empty()) return "";
  return fmt::format(
      "Check: each trial in turn was compared with the band that the other {} give for one new trial. It "
      "lies inside at {}; {}.",
      g.curves.size() - 1, inside_text(g.left_out), width_text(g.left_out));
}

// Exponent of the area with which the predicted force would match the held-out force on average.
std::string area_power_text(const ProfilePrediction& p, double ratio) {
  const double area = std::pow(p.diameter_m / p.from_diameter_m, 2);
  if (p.law != kAreaLaw || std::abs(area - 1.0) < 0.01 || !(ratio > 0.0)) return "";
  return fmt::format(
      " This law lets the force grow with the area to the power 1; these trials give the power {:.2f}. A "
      "floor, a "
      "wall or a layer near the plate raises it, a bed that hardens with depth lowers it.",
      1.0 + std::log(ratio) / std::log(area));
}

std::string prediction_text(const ProfilePrediction& p) {
  double ratio = 0.0;
  for (const auto& t : p.trials) ratio += t.force_ratio / static_cast<double>(p.trials.size());
  return fmt::format(
      "{} mm from {} mm, {} ({}): the held-out trials lie in the band of one new trial at {}; {}. Their "
      "force is {} the "
      "predicted one.{}",
      mm_text(p.diameter_m), mm_text(p.from_diameter_m), p.law, p.text, inside_text(p.trials),
      width_text(p.trials), std::isfinite(ratio) ? fmt::format("{:.2f} times", ratio) : "–",
      area_power_text(p, ratio));
}

// Deepest round depth that every trial reached, or that most trials reached.
double deepest_with_most_trials(const CurveGroup& g, const std::vector<double>& depths_m) {
  double found_m = depths_m.front();
  for (const double depth_m : depths_m)
    if (g.at(depth_m)->force_N.trials >= g.at(found_m)->force_N.trials) found_m = depth_m;
  return found_m;
}

std::string bound_text(const CurveGroup& g) {
  double deepest_m = 0.0, force_N = 0.0;
  for (const auto& curve : g.curves) {
    deepest_m = std::max(deepest_m, curve.to_m);
    force_N = std::max(force_N, curve.greatest_N);
  }
  return fmt::format(
      "The ground is {}: at least {} N/m. It bore {} N, and the foot went in by {} mm, which cannot be "
      "told from none.",
      g.at_least_N_per_m > stiffest_granular_N_per_m() ? "rigid" : "not shown to be rigid",
      short_number(g.at_least_N_per_m), short_number(force_N), mm_text(deepest_m));
}

std::string profile_answer(const CurveGroup& g) {
  const auto depths = listed_depths_m(g);
  if (depths.empty()) return bound_text(g);
  const auto deepest_m = deepest_with_most_trials(g, depths);
  const auto& force = g.at(deepest_m)->force_N;
  const auto foot = fmt::format("{} of {} mm", foot_word(g.source), mm_text(g.diameter_m));
  if (force.trials < 2)
    return fmt::format("At {} mm of depth the ground bears {} N ({}, one trial: others may differ).",
                       mm_text(deepest_m), short_number(force.value), foot);
  return fmt::format(
      "At {} mm of depth the ground bears {} N, 95 % interval {} to {} N ({}, mean of {}); "
      "one new trial lies between {} and {} N with 95 %.",
      mm_text(deepest_m), in_interval(force.value, force.mean_low, force.mean_high),
      in_interval(force.mean_low, force.mean_low, force.mean_high),
      in_interval(force.mean_high, force.mean_low, force.mean_high), foot, trials_text(force.trials),
      in_interval(force.new_low, force.new_low, force.new_high),
      in_interval(force.new_high, force.new_low, force.new_high));
}

std::vector<std::string> profile_lines(const ProfileConclusion& conclusion) {
  std::vector<std::string> lines;
  for (const auto& g : conclusion.groups) {
    lines.push_back("strength profile: " + group_title(g));
    if (g.depths.empty()) {
      lines.push_back("  " + bound_text(g));
      continue;
    }
    lines.push_back(fmt::format("  {:>9}  {:>26}  {:>18}  {:>26}  {:>6}", "depth",
                                "force, mean of the ground", "one new trial", "secant", "trials"));
    for (const double depth_m : listed_depths_m(g)) lines.push_back(table_line(*g.at(depth_m)));
    if (const auto text = numbers_text(g); !text.empty()) lines.push_back("  " + text);
    lines.push_back("  " + shapes_text(g));
    if (const auto text = left_out_text(g); !text.empty()) lines.push_back("  " + text);
  }
  for (const auto& p : conclusion.predictions) lines.push_back("  held out: " + prediction_text(p));
  return lines;
}

std::string profile_csv(const ProfileConclusion& conclusion) {
  std::string csv =
      "source,foot_diameter_m,depth_m,trials,force_N,force_mean_low_N,force_mean_high_N,force_new_low_N,"
      "force_new_high_N,force_between_sd_N,secant_N_per_m,tangent_N_per_m,tangent_mean_low_N_per_m,"
      "tangent_mean_high_N_per_m,tangent_new_low_N_per_m,tangent_new_high_N_per_m\n";
  const auto cell = [](double value) { return std::isfinite(value) ? fmt::format("{:.7g}", value) : ""; };
  for (const auto& g : conclusion.groups)
    for (const auto& p : g.depths) {
      const auto &f = p.force_N, &k = p.tangent_N_per_m;
      csv += fmt::format("{},{:.6g},{:.6g},{}", name_of(g.source), g.diameter_m, p.depth_m, f.trials);
      for (const double value :
           {f.value, f.mean_low, f.mean_high, f.new_low, f.new_high, f.trials > 1 ? f.between_sd : NAN,
            f.value / p.depth_m, k.value, k.mean_low, k.mean_high, k.new_low, k.new_high})
        csv += "," + cell(value);
      csv += "\n";
    }
  return csv;
}

Json profile_json(const ProfileConclusion& conclusion) {
  Json json = Json::object();
  for (const auto& g : conclusion.groups) {
    Json depths = Json::array();
    for (const auto& p : g.depths)
      depths.push_back({{"depth_m", p.depth_m},
                        {"force_N", value_json(p.force_N)},
                        {"secant_N_per_m", value_json(p.force_N, 1.0 / p.depth_m)},
                        {"tangent_N_per_m", value_json(p.tangent_N_per_m)}});
    Json slope = value_json(g.slope_N_per_m);
    slope["from_m"] = g.slope_from_m;
    slope["to_m"] = g.slope_to_m;
    json["groups"].push_back(
        {{"source", name_of(g.source)},
         {"foot_diameter_m", g.diameter_m},
         {"trials", g.curves.size()},
         {"at_least_N_per_m", g.depths.empty() ? Json(g.at_least_N_per_m) : Json(nullptr)},
         {"rigid", g.depths.empty() && g.at_least_N_per_m > stiffest_granular_N_per_m()},
         {"slope_N_per_m", std::move(slope)},
         {"line_N_per_m", value_json(g.line_N_per_m)},
         {"secant_20mm_N_per_m", value_json(g.secant_20mm_N_per_m)},
         {"exponent", value_json(g.exponent)},
         {"leave_one_trial_out", in_band_json(g.left_out)},
         {"depths", std::move(depths)}});
  }
  for (const auto& p : conclusion.predictions) {
    const auto [inside, depths] = inside_of(p.trials);
    json["held_out"].push_back({{"law", p.law},
                                {"from_diameter_m", p.from_diameter_m},
                                {"diameter_m", p.diameter_m},
                                {"depths", depths},
                                {"inside", inside},
                                {"trials", in_band_json(p.trials)}});
  }
  return json;
}

}  // namespace sandhopper
