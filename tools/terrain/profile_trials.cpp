#include "tools/terrain/profile_trials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/terrain/intrusion_fit.hpp"
#include "tools/terrain/penetrometer.hpp"

namespace sandhopper {
namespace {

constexpr double kReferenceSpeed_mps = 1.0;  // reference speed of the rate law (terrain/resistance_law.hpp)

std::vector<PenetrometerDrop> drops_of(std::span<const TrialResult* const> results) {
  std::vector<PenetrometerDrop> drops;
  for (const auto* result : results)
    if (holds_drop(*result)) drops.push_back(drop_from(*result));
  return drops;
}

double moving_mass_kg(const PenetrometerDrop& drop, double mass_kg) {
  auto body = drop.body;
  body.mass_kg = mass_kg;
  return coefficients(drop.fluid, body).moving_mass_kg;
}

// Force of the bed on the body, at the reference speed if the drops have a rate law.
StrengthCurve curve_of_drop(const PenetrometerDrop& drop, double rate) {
  const double mass_kg = moving_mass_kg(drop, drop.body.mass_kg);
  const double range_kg = moving_mass_kg(drop, drop.mass_max_kg) - moving_mass_kg(drop, drop.mass_min_kg);
  CurveFacts facts{.source = CurveSource::drop,
                   .diameter_m = 2.0 * std::sqrt(drop.body.frontal_area_m2 / std::numbers::pi),
                   .shared_sd_relative = range_kg / std::sqrt(12.0) / mass_kg,
                   .quasi_static = true};
  std::vector<LoadingSample> samples;
  double t_s = 0.0, before_m = 0.0;
  for (const auto& s : drop.penetration) {
    if (!(s.speed_mps > 0.0)) continue;
    t_s += (s.depth_m - before_m) / s.speed_mps;
    before_m = s.depth_m;
    samples.push_back({t_s, s.depth_m, s.speed_mps, 0.0,
                       mass_kg * s.resistance * std::pow(kReferenceSpeed_mps / s.speed_mps, rate)});
  }
  auto curve = curve_of(samples, facts);
  curve.trial = drop.trial;
  return curve;
}

void add_drops(std::span<const TrialResult* const> results, std::vector<StrengthCurve>& curves,
               std::vector<std::string>& notes) {
  const auto drops = drops_of(results);
  if (drops.empty()) return;
  const auto fit = fit_penetrations(drops);
  const auto& law = fit.laws[fit.chosen];
  const bool has_rate = law.fit.law == ResistanceLaw::depth_power_rate;
  for (const auto& drop : drops) curves.push_back(curve_of_drop(drop, has_rate ? law.fit.rate : 0.0));
  notes.push_back(
      has_rate ? fmt::format("A drop is fast at the surface and slow at its end. Its force is given at "
                             "{:.0f} m/s, by the drops' own rate law v^{:.2f}; a bed without a rate "
                             "would need no such step. The error of the exponent is not in the bands.",
                             kReferenceSpeed_mps, law.fit.rate)
               : std::string("The force is that at the speed of the fall, which differs with depth."));
  notes.emplace_back(
      "The mass of the falling body is known only within a range, the same for all drops; its part is in "
      "both bands.");
}

std::vector<AreaWay> press_laws(std::span<const TrialResult* const> results) {
  std::vector<PressTrial> presses;
  for (const auto* result : results)
    if (holds_press(*result)) presses.push_back(press_from(*result));
  const bool held_out = std::ranges::any_of(presses, [](const auto& press) { return press.held_out; });
  if (presses.empty() || !held_out) return {};
  const auto fit = fit_intrusions(presses);
  if (!fit.chosen) return {};
  const auto law = fit.laws[*fit.chosen].fit;
  std::string name(name_of(law.law));
  std::ranges::replace(name, '_', ' ');
  return {{.law = name,
           .text = "by the depth law that the trials not held out choose, fitted on them",
           .ratio = [law, options = fit.options](double depth_m, double from_m, double to_m) {
             return depth_law_force_N(law, depth_m, to_m, options) /
                    depth_law_force_N(law, depth_m, from_m, options);
           }}};
}

double area_ratio(double, double from_m, double to_m) { return to_m * to_m / (from_m * from_m); }

}  // namespace

ProfileConclusion conclude_profile(std::span<const StrengthCurve> curves, std::span<const AreaWay> laws) {
  ProfileConclusion out{.groups = pool_curves(curves)};
  for (const auto& curve : curves)
    if (curve.held_out && !curve.force_N.empty()) out.held_out.push_back(curve);
  std::vector<AreaWay> ways{{.law = std::string(kAreaLaw),
                             .text = "in proportion to the area at the same depth",
                             .ratio = area_ratio}};
  ways.insert(ways.end(), laws.begin(), laws.end());
  for (const auto& group : out.groups)
    for (const auto& way : ways)
      for (const auto& curve : out.held_out) {
        if (curve.source != group.source) continue;
        auto same = std::ranges::find_if(out.predictions, [&](const auto& p) {
          return p.law == way.law && p.source == group.source && p.from_diameter_m == group.diameter_m &&
                 p.diameter_m == curve.diameter_m;
        });
        if (same == out.predictions.end()) {
          const auto ratio = [&](double depth_m) {
            return way.ratio(depth_m, group.diameter_m, curve.diameter_m);
          };
          out.predictions.push_back({.law = way.law,
                                     .text = way.text,
                                     .source = group.source,
                                     .from_diameter_m = group.diameter_m,
                                     .diameter_m = curve.diameter_m,
                                     .band = scaled(group, ratio)});
          same = out.predictions.end() - 1;
        }
        same->trials.push_back(in_band(curve, same->band));
      }
  return out;
}

bool ProfileTrials::takes(CampaignPlant plant, TrialKind kind) const {
  return (plant == CampaignPlant::hopper && kind == TrialKind::hop) ||
         (plant == CampaignPlant::intruder &&
          (kind == TrialKind::intrusion || kind == TrialKind::press || kind == TrialKind::tap)) ||
         (plant == CampaignPlant::falling_body && kind == TrialKind::drop);
}

void ProfileTrials::analyse(const CampaignTrial&, const TrialRecording&, TrialResult&) const {}

CampaignConclusions ProfileTrials::conclude(std::span<const TrialResult* const> results) const {
  std::vector<StrengthCurve> curves;
  std::vector<std::string> notes;
  for (const auto* result : results)
    for (auto& curve : curves_of(*result)) curves.push_back(std::move(curve));
  add_drops(results, curves, notes);
  auto conclusion = conclude_profile(curves, press_laws(results));
  conclusion.notes = std::move(notes);
  return conclusion.groups.empty() ? CampaignConclusions{} : tell_profile(conclusion);
}

}  // namespace sandhopper
