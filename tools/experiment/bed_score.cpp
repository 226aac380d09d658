#include "tools/experiment/bed_score.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "terrain/ground_summary.hpp"
#include "tools/experiment/parallel.hpp"
#include "tools/experiment/statistics.hpp"

namespace sandhopper {
namespace {

constexpr double kNormal975 = 1.959964;
constexpr double kWidthDepth_m = 0.020;
constexpr double kNone_m = std::numeric_limits<double>::infinity();
constexpr double kSamePlace_m = 0.010;  // an event found farther away is a different one
constexpr double kAccurate_m = 0.002;
constexpr double kNear_m = 0.005;
constexpr double kBeyond_m = 0.001;  // the foot must pass an event by this much for it to count as having
                                     // happened
constexpr double kFast_mps =
    0.3;  // from this speed on, the blow alone is the force at which contact is found
constexpr int kStrides = 3;

// `true_depth_m` is infinite if the bed has no such event.
void score_event(const GroundEvent& event, GroundEventKind kind, double true_depth_m, double deepest_m,
                 EventScore& score) {
  const bool happened = deepest_m > true_depth_m + kBeyond_m;
  const bool reported = event.kind == kind;
  if (!happened) {
    score.absent += 1.0;
    score.false_alarms += reported;
    if (event.threshold > 0.0) {
      score.largest_absent = std::max(score.largest_absent, event.statistic / event.threshold);
      score.absent_statistics.push_back(event.statistic / event.threshold);
    }
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

void score_events(const GroundEvents& found, const BedStride& stride, const BedTruth& truth,
                  EventScores& score) {
  const double deepest = stride.true_deepest_m, crater = stride.true_crater_m;
  // Events above the crater's deepest point belong to an earlier stride.
  const auto depth_of = [&](const std::optional<double>& depth) {
    return depth && *depth > crater - kBeyond_m ? *depth : kNone_m;
  };
  score_event(found.rupture, GroundEventKind::crust_rupture, depth_of(truth.rupture_depth_m), deepest,
              score.rupture);
  // Near the boundary the foot felt only a part of it, so the stride counts neither as present nor as absent.
  const double boundary = depth_of(truth.boundary_depth_m);
  const double near = truth.boundary_depth_m.value_or(kNone_m);
  if (!(std::abs(deepest - near) <= kNear_m) && !(crater > 0.0 && std::abs(crater - near) <= kNear_m))
    score_event(found.boundary, GroundEventKind::layer_boundary, boundary, deepest, score.boundary);
  score_event(found.boundary, GroundEventKind::box_floor, depth_of(truth.floor_depth_m), deepest,
              score.floor);
  // While the foot leaves, suction acts just above the crater's floor, which is not below the deepest point.
  const double pull = truth.suction_N.has_value() ? deepest - 2.0 * kBeyond_m : kNone_m;
  score_event(found.suction, GroundEventKind::suction, pull, deepest, score.suction);
}

// All results for one stride that are computed outside the cycle.
struct Answer {
  JointEstimate joint{};
  StrengthProfile profile{};
  GroundSummary ground{};
  GroundEvents events{};
  ProfileSolver::ContactDepth contact{};  // expected after the stride
  double solve_s = 0.0, search_s = 0.0;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<Answer> answers_to(const BedTrial& trial, const StiffnessConfig& config) {
  ProfileSolver solver(config);
  std::vector<Answer> answers;
  for (const auto& stride : trial.strides) {
    Answer& answer = answers.emplace_back();
    const auto start = std::chrono::steady_clock::now();
    answer.joint = solve_joint(stride.sums.joint, config);
    solver.add(stride.sums.profile, stride.sums.summary.stride);
    answer.ground = summarise(solver);
    answer.profile = solver.profile();
    answer.solve_s = seconds_since(start);
    const auto& sums = stride.sums.profile;
    answer.contact = solver.contact_depth(sums.contact_mps, sums.contact_added_mass_kg_per_m);
    const auto search = std::chrono::steady_clock::now();
    answer.events = find_ground_events(stride.events, ground_event_config(config), answer.profile);
    answer.search_s = seconds_since(search);
  }
  return answers;
}

void score_contact(const StrideDepthErrors& errors, double speed_mps, double expected_m, double lag_s,
                   ContactTimeScore& score) {
  if (errors.empty() || speed_mps < kFast_mps) return;
  const auto& first = errors.front();
  score.error_speed_m2_per_s += (first.error_m - expected_m - lag_s * first.change_mps) * speed_mps;
  score.speed_squared_m2_per_s2 += speed_mps * speed_mps;
}

void score_first(const BedStride& stride, const BedTruth& truth, const Answer& answer, double steady_drag,
                 FirstStrideScore& score) {
  score.strides += 1.0;
  score_band(answer.profile, truth, 0.0, stride.true_deepest_m, score.band);
  if (steady_drag != 0.0)
    score_band(answer.profile, truth, 0.0, stride.true_deepest_m,
               steady_drag < 0.0 ? score.less_drag : score.more_drag);
  if (stride.true_deepest_m >= kWidthDepth_m)
    score.width_20mm.push_back(2.0 * kNormal975 * force_at(answer.profile, kWidthDepth_m).sd /
                               truth.force_at_N(kWidthDepth_m));
  const bool joint_valid = answer.joint.validity == Validity::valid;
  score.line_valid += answer.ground.line_valid;
  score.joint_valid += joint_valid;
  score.shapes[static_cast<std::size_t>(answer.ground.shape)] += 1.0;
  if (!truth.line_N_per_m || !joint_valid || !answer.ground.line_valid) return;
  const auto& line = answer.ground.line_N_per_m;
  score.slope.add(line.value, line.ci95_low, line.ci95_high, *truth.line_N_per_m);
  score.joint_slope.add(answer.joint.value_N_per_m, answer.joint.ci95_low_N_per_m,
                        answer.joint.ci95_high_N_per_m, *truth.line_N_per_m);
}

void score_later(const BedStride& stride, const BedTruth& truth, const Answer& answer, double depth_error_m,
                 CraterScore& score) {
  const auto& profile = answer.profile;
  score.strides += 1.0;
  if (stride.landing_error_m) {
    score.landings += 1.0;
    score.landing_error_m += *stride.landing_error_m;
    score.landing_squared_m2 += *stride.landing_error_m * *stride.landing_error_m;
  }
  const auto& k = answer.ground.reloading_N_per_m;
  if (k.ci95_low > 0.0 && std::isfinite(k.ci95_high)) {
    score.reloading.add(k.value, k.ci95_low, k.ci95_high, truth.unloading_stiffness_N_per_m);
    score.reloading_width.push_back((k.ci95_high - k.ci95_low) / truth.unloading_stiffness_N_per_m);
  } else {
    score.bounds += k.ci95_low > 0.0;
  }
  score_band(profile, truth, 0.0, stride.true_deepest_m, score.band);
  if (!(std::min(stride.true_deepest_m, kProfileDepth_m) > stride.true_crater_m + depth_error_m)) return;
  score.deeper += 1.0;
  if (profile.samples == 0) return;
  score.curves += 1.0;
  score_band(profile, truth, stride.true_crater_m, stride.true_deepest_m, score.fresh);
}

void score_trial(const BedScoreSetup& setup, const BedTrial& trial, double steady_drag, BedScore& score,
                 std::mutex& adding) {
  const auto& config = setup.cycle.stiffness;
  const auto answers = answers_to(trial, config);
  const std::lock_guard lock(adding);
  score.trials += 1.0;
  score.incomplete += trial.strides.empty();
  score.contact_error_m += trial.contact_error_m;
  score.depth_errors.push_back(trial.depth_errors);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const auto& stride = trial.strides[i];
    const auto& answer = answers[i];
    if (i == 0) {
      score_first(stride, trial.truth, answer, steady_drag, score.first);
      score_contact(trial.depth_errors, stride.sums.profile.contact_mps, answer.contact.mean_m,
                    config.profile_or_default().depth_lag_s, score.contact_time);
    } else {
      score_later(stride, trial.truth, answer, kNormal975 * config.profile_or_default().landing_depth_sd_m,
                  score.crater);
    }
    score.solve_s.push_back(answer.solve_s);
    score.search_s.push_back(answer.search_s);
    if (stride.events_complete)
      score_events(answer.events, stride, trial.truth, i == 0 ? score.first_events : score.later_events);
  }
}

}  // namespace

void NumberScore::add(double value, double low, double high, double truth) {
  count += 1.0;
  absolute_error += std::abs(value / truth - 1.0);
  covered += low <= truth && truth <= high;
}

namespace {

std::optional<Place> first_place(const BedTrial& trial) {
  if (trial.strides.empty()) return std::nullopt;
  const auto& stride = trial.strides.front();
  return Place{.sums = stride.sums.profile, .truth = trial.truth, .deepest_m = stride.true_deepest_m};
}

std::uint64_t seed_of(const BedScoreSetup& setup, long number) {
  return setup.first_seed + static_cast<std::uint64_t>(number);
}

// The world with ground number `number`, from 0.
WorldConfig ground_of(const BedScoreSetup& setup, long number) {
  return on_drawn_ground(setup.world, setup.ground, seed_of(setup, number));
}

// One robot hops on all places of a ground.
BedTrial trial_on(const BedScoreSetup& setup, const BedCase& bed, long number, long ground, int strides) {
  return run_bed_trial(setup.cycle, ground_of(setup, ground), bed, seed_of(setup, number), strides,
                       seed_of(setup, ground));
}

// First strides of `places` places on one ground. A trial without a stride is repeated once at most.
std::vector<Place> session_of(const BedScoreSetup& setup, const BedCase& bed, long session, int places) {
  std::vector<Place> strides;
  for (int i = 0; i < 2 * places && static_cast<int>(strides.size()) < places; ++i) {
    const long number = session * places + (i < places ? i : setup.trials + i - places);
    if (const auto place = first_place(trial_on(setup, bed, number, session, 1))) strides.push_back(*place);
  }
  return strides;
}

PlacesScore score_of_places(const BedScoreSetup& setup, const BedCase& bed, int places,
                            const FirstStrideScore& first) {
  if (places == 1) return {.places = 1, .sessions = first.strides, .band = first.band};
  PlacesScore score{.places = places};
  std::mutex adding;
  parallel_for(setup.trials / places, setup.threads, [&](long i) {
    const auto session = session_of(setup, bed, i, places);
    if (static_cast<int>(session.size()) < places) return;
    const std::lock_guard lock(adding);
    score_session(session, setup.cycle.stiffness, score);
  });
  return score;
}

}  // namespace

std::vector<BedScore> score_beds(const BedScoreSetup& setup) {
  const auto cases = named_bed_cases(setup.beds);
  std::vector<BedScore> scores;
  long done_before = 0;
  for (const auto& bed : cases) {
    auto& score = scores.emplace_back(BedScore{.bed = bed.name});
    std::mutex adding;
    parallel_for(
        setup.trials, setup.threads,
        [&](long i) {
          const double steady_drag = ground_of(setup, i).terrain.steady_drag_coefficient;
          score_trial(setup, trial_on(setup, bed, i, i, kStrides), steady_drag, score, adding);
        },
        [&](long done, long) {
          if (setup.progress)
            setup.progress(done_before + done, setup.trials * static_cast<long>(cases.size()));
        });
    if (has_common_curve(bed))
      for (const int places : setup.places)
        score.places.push_back(score_of_places(setup, bed, places, score.first));
    done_before += setup.trials;
    if (setup.finished) setup.finished(score);
  }
  return scores;
}

namespace {

nlohmann::ordered_json json_of(const CoverageScore& s) {
  return {{"depths", s.depths},
          {"coverage", s.share()},
          {"rms_relative_error", std::sqrt(s.squared_error / s.depths)}};
}

nlohmann::ordered_json json_of(const NumberScore& s) {
  return {{"count", s.count},
          {"mean_relative_error", s.absolute_error / s.count},
          {"coverage", s.covered / s.count}};
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

nlohmann::ordered_json json_of(const EventScores& s) {
  return {{"rupture", json_of(s.rupture)},
          {"boundary", json_of(s.boundary)},
          {"floor", json_of(s.floor)},
          {"suction", json_of(s.suction)}};
}

}  // namespace

void to_json(nlohmann::ordered_json& json, const BedScore& s) {
  const auto depth = depth_error_spread(s.depth_errors);
  nlohmann::ordered_json shapes;
  for (std::size_t i = 0; i < s.first.shapes.size(); ++i)
    shapes[std::string(EnumNames<GroundShape>::value[i])] = s.first.shapes[i];
  auto places = nlohmann::ordered_json::array();
  for (const auto& p : s.places)
    places.push_back({{"places", p.places}, {"sessions", p.sessions}, {"band", json_of(p.band)}});
  json = {{"bed", s.bed},
          {"trials", s.trials},
          {"incomplete", s.incomplete},
          {"mean_contact_error_m", s.contact_error_m / std::max(1.0, s.trials - s.incomplete)},
          {"depth_errors",
           {{"surface_sd_m", depth.surface_sd_m},
            {"filter_sd_m", depth.filter_sd_m},
            {"lag_sd_s", depth.lag_sd_s},
            {"rest_sd_m", depth.rest_sd_m},
            {"contact_time_remaining_s", s.contact_time.remaining_s()}}},
          {"first_strides",
           {{"strides", s.first.strides},
            {"band", json_of(s.first.band)},
            {"less_drag", json_of(s.first.less_drag)},
            {"more_drag", json_of(s.first.more_drag)},
            {"median_width_20mm", median(s.first.width_20mm)},
            {"line_valid", s.first.line_valid},
            {"joint_valid", s.first.joint_valid},
            {"slope", json_of(s.first.slope)},
            {"joint_slope", json_of(s.first.joint_slope)},
            {"shapes", shapes},
            {"events", json_of(s.first_events)}}},
          {"later_strides",
           {{"strides", s.crater.strides},
            {"reloading", json_of(s.crater.reloading)},
            {"reloading_bounds", s.crater.bounds},
            {"median_reloading_width", median(s.crater.reloading_width)},
            {"deeper", s.crater.deeper},
            {"curves", s.crater.curves},
            {"fresh_depths", json_of(s.crater.fresh)},
            {"band", json_of(s.crater.band)},
            {"landings", s.crater.landings},
            {"landing_mean_m", s.crater.landing_error_m / std::max(1.0, s.crater.landings)},
            {"landing_rms_m", s.crater.landing_rms_m()},
            {"events", json_of(s.later_events)}}},
          {"places", places},
          {"median_solve_s", median(s.solve_s)},
          {"median_search_s", median(s.search_s)}};
}

}  // namespace sandhopper
