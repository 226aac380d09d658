#include "tools/experiment/bed_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "terrain/ground_summary.hpp"
#include "tools/experiment/parallel.hpp"

namespace sandhopper {
namespace {

constexpr double kNormal975 = 1.959964;
constexpr double kFirstDepth_m = 0.002;  // shallower, the surface's own error is larger than the force
constexpr double kWidthDepth_m = 0.020;
constexpr double kNone_m = std::numeric_limits<double>::infinity();
constexpr double kPitch_m = 0.001;
constexpr double kSamePlace_m = 0.010;  // farther off, what was found is something else
constexpr double kAccurate_m = 0.002;
constexpr double kNear_m = 0.005;
constexpr double kBeyond_m = 0.001;  // how far the foot must go past an event for it to have happened

// Linear between the claim's depths; NaN outside of them.
double between(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::ranges::upper_bound(x, at);
  if (above == x.begin() || above == x.end()) return std::numeric_limits<double>::quiet_NaN();
  const auto i = static_cast<std::size_t>(above - x.begin()) - 1;
  return y[i] + (at - x[i]) / (x[i + 1] - x[i]) * (y[i + 1] - y[i]);
}

void score_claim(const BedStride& stride, const ProfileClaim& claim, ProfileScore& score) {
  score.claims += 1.0;
  score.lines_valid += claim.line_valid;
  for (double z = kFirstDepth_m; z <= stride.true_max_depth_m; z += kPitch_m) {
    const double mean = between(claim.depth_m, claim.mean_N, z), sd = between(claim.depth_m, claim.sd_N, z);
    const double truth = stride.truth.force_at_N(z);
    if (!std::isfinite(mean) || !std::isfinite(sd)) continue;
    score.depths += 1.0;
    score.covered += std::abs(mean - truth) <= kNormal975 * sd;
    score.squared_error += (mean / truth - 1.0) * (mean / truth - 1.0);
  }
  const double sd = between(claim.depth_m, claim.sd_N, kWidthDepth_m);
  if (stride.true_max_depth_m >= kWidthDepth_m && std::isfinite(sd))
    score.width_20mm.push_back(2.0 * kNormal975 * sd / stride.truth.force_at_N(kWidthDepth_m));
}

// `true_depth_m`: infinite where the bed has no such thing.
void score_event(const GroundEvent& event, GroundEventKind kind, double true_depth_m, double deepest_m,
                 EventScore& score) {
  const bool happened = deepest_m > true_depth_m + kBeyond_m;
  const bool reported = event.kind == kind;
  if (!happened) {
    score.absent += 1.0;
    score.false_alarms += reported;
    if (event.threshold > 0.0)
      score.largest_absent = std::max(score.largest_absent, event.statistic / event.threshold);
    return;
  }
  score.possible += 1.0;
  const double error = event.depth_m - true_depth_m;
  if (!reported || std::abs(error) > kSamePlace_m) return;
  score.found += 1.0;
  score.within_2mm += std::abs(error) <= kAccurate_m;
  score.depth_error_m += error;
  score.depth_error_squared_m2 += error * error;
}

GroundEvents events_of(const BedStride& stride, const GroundEventConfig& config) {
  GroundEventRecorder recorder(config, stride.truth.foot_radius_m);
  recorder.restart(0.0);
  for (const auto& sample : stride.samples) {
    recorder.add(sample);
    if (std::ranges::find(stride.phase_changes_s, sample.since_contact_s) != stride.phase_changes_s.end())
      recorder.on_phase_change(sample.since_contact_s);
  }
  return find_ground_events(recorder.sums(), config);
}

void score_stride(const BedScoreSetup& setup, const BedCase& bed, std::uint64_t seed, BedScore& score,
                  std::mutex& adding) {
  const auto stride = run_bed_stride(setup.cycle, setup.world, bed, seed);
  std::vector<std::optional<ProfileClaim>> claims;
  GroundEvents events;
  if (stride.complete) {
    for (const auto& provider : setup.providers) claims.push_back(provider.claim(stride));
    events = events_of(stride, setup.events);
  }
  const std::lock_guard lock(adding);
  score.strides += 1.0;
  if (!stride.complete) {
    score.incomplete += 1.0;
    return;
  }
  score.contact_error_m += stride.contact_error_m;
  for (std::size_t p = 0; p < claims.size(); ++p)
    if (claims[p]) score_claim(stride, *claims[p], score.profile[p]);
  const auto& truth = stride.truth;
  const double deepest = stride.true_max_depth_m;
  score_event(events.rupture, GroundEventKind::crust_rupture, truth.rupture_depth_m.value_or(kNone_m),
              deepest, score.rupture);
  // A foot that only came near the boundary felt a part of it: neither there nor absent.
  const double boundary = truth.boundary_depth_m.value_or(kNone_m);
  if (!(std::abs(deepest - boundary) <= kNear_m))
    score_event(events.boundary, GroundEventKind::layer_boundary, boundary, deepest, score.boundary);
  score_event(events.boundary, GroundEventKind::box_floor, truth.floor_depth_m.value_or(kNone_m), deepest,
              score.floor);
  // A foot that leaves meets suction just above its crater's floor, which is not deeper than the deepest
  // point.
  const double pull = truth.suction_N.has_value() ? deepest - 2.0 * kBeyond_m : kNone_m;
  score_event(events.suction, GroundEventKind::suction, pull, deepest, score.suction);
}

nlohmann::ordered_json json_of(const EventScore& s) {
  return {{"possible", s.possible},
          {"found", s.found},
          {"within_2mm", s.within_2mm},
          {"mean_depth_error_m", s.depth_error_m / std::max(1.0, s.found)},
          {"rms_depth_error_m", std::sqrt(s.depth_error_squared_m2 / std::max(1.0, s.found))},
          {"absent", s.absent},
          {"false_alarms", s.false_alarms},
          {"largest_absent", s.largest_absent}};
}

}  // namespace

ProfileProvider strength_profile_provider(const StiffnessConfig& config) {
  return {"strength profile", [config](const BedStride& stride) -> std::optional<ProfileClaim> {
            if (stride.profile.samples == 0) return std::nullopt;
            ProfileSolver solver(config);
            solver.add(stride.profile, 1);
            const auto& p = solver.profile();
            ProfileClaim claim;
            claim.line_valid = summarise(solver, stride.profile).line_valid;
            const double last_m = p.depth_max_m + kProfilePoint_m;
            for (std::size_t i = 0; i <= kProfilePoints; ++i) {
              const double z = static_cast<double>(i) * kProfilePoint_m;
              if (z > last_m) break;
              const auto force = force_at(p, z);
              claim.depth_m.push_back(z);
              claim.mean_N.push_back(force.value);
              claim.sd_N.push_back(force.sd);
            }
            return claim;
          }};
}

double ProfileScore::median_width_20mm() const {
  if (width_20mm.empty()) return std::numeric_limits<double>::quiet_NaN();
  auto sorted = width_20mm;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  return *middle;
}

ProfileProvider joint_line_provider(const StiffnessConfig& config) {
  return {"joint line", [config](const BedStride& stride) -> std::optional<ProfileClaim> {
            const auto& joint = stride.result.joint;
            if (!(joint.value_N_per_m > 0.0)) return std::nullopt;
            ProfileClaim claim;
            claim.line_valid = joint.validity == Validity::valid;
            for (double z = 0.0; z < 0.08; z += kPitch_m) {
              const double effective =
                  z + joint.intercept_depth_m * (1.0 - std::exp(-z / config.joint.intercept_growth_depth_m));
              claim.depth_m.push_back(z);
              claim.mean_N.push_back(joint.value_N_per_m * effective);
              claim.sd_N.push_back(joint.standard_error_N_per_m * effective);
            }
            return claim;
          }};
}

std::vector<BedScore> score_beds(const BedScoreSetup& setup) {
  std::vector<BedCase> cases;
  for (const auto& bed : bed_cases())
    if (setup.beds.empty() || std::ranges::find(setup.beds, bed.name) != setup.beds.end())
      cases.push_back(bed);
  for (const auto& name : setup.beds)
    if (std::ranges::find(cases, name, &BedCase::name) == cases.end())
      throw std::invalid_argument("no bed '" + name + "'");
  std::vector<BedScore> scores;
  for (const auto& bed : cases) {
    scores.push_back({.bed = bed.name, .smooth = bed.smooth});
    scores.back().profile.resize(setup.providers.size());
  }
  std::mutex adding;
  parallel_for(
      setup.strides * static_cast<long>(cases.size()), setup.threads,
      [&](long i) {
        const auto bed = static_cast<std::size_t>(i / setup.strides);
        const auto seed = setup.first_seed + static_cast<std::uint64_t>(i % setup.strides);
        score_stride(setup, cases[bed], seed, scores[bed], adding);
      },
      setup.progress);
  return scores;
}

void to_json(nlohmann::ordered_json& json, const BedScore& s) {
  json = {{"bed", s.bed},
          {"smooth", s.smooth},
          {"strides", s.strides},
          {"incomplete", s.incomplete},
          {"mean_contact_error_m", s.contact_error_m / std::max(1.0, s.strides - s.incomplete)},
          {"rupture", json_of(s.rupture)},
          {"boundary", json_of(s.boundary)},
          {"floor", json_of(s.floor)},
          {"suction", json_of(s.suction)}};
  auto& profiles = json["profile"] = nlohmann::ordered_json::array();
  for (const auto& p : s.profile)
    profiles.push_back({{"claims", p.claims},
                        {"depths", p.depths},
                        {"coverage", p.coverage()},
                        {"rms_relative_error", std::sqrt(p.squared_error / p.depths)},
                        {"median_width_20mm", p.median_width_20mm()},
                        {"lines_valid", p.lines_valid}});
}

}  // namespace sandhopper
