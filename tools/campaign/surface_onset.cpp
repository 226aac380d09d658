#include "tools/campaign/surface_onset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/lost_forces.hpp"
#include "tools/campaign/setup_keys.hpp"
#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

constexpr std::size_t kIdleRows = 10;   // fewest rows of a mean and a standard deviation
constexpr double kOnsetClear = 5.0;     // in standard deviations, of each thing that must be clear
constexpr double kSteepest = 3.0;       // a cone; see the header
constexpr double kHole = 0.5;           // share of the depth from which check_surface sees a hole
constexpr double kOutOfLevel = 0.0349;  // sin(2 degrees)

// The first stroke: samples of the force down to where the foot first comes back by a tenth of its way.
// Forces that were not measured are left out.
struct Stroke {
  explicit Stroke(const TrialRecording& recording) {
    const ForceAtDepth pairs(recording);
    std::vector<bool> is_lost(recording.rows(), false);
    for (const auto& lost : lost_forces(recording))
      for (std::size_t row = lost.first_row; row <= lost.last_row; ++row) is_lost[row] = true;
    for (std::size_t i = 0; i < pairs.size(); ++i)
      if (!is_lost[pairs.rows[i]]) depth_m.push_back(-pairs.z_m[i]), force_N.push_back(pairs.force_N[i]);
    if (!depth_m.empty()) end_where_it_turns();
  }

  std::vector<double> depth_m, force_N;

 private:
  void end_where_it_turns() {
    constexpr double kBack = 0.1;
    const auto [least, most] = std::ranges::minmax(depth_m);
    std::size_t deepest = 0;
    for (std::size_t i = 0; i < depth_m.size(); ++i) {
      if (depth_m[i] > depth_m[deepest]) deepest = i;
      if (depth_m[i] < depth_m[deepest] - kBack * (most - least)) break;
    }
    depth_m.resize(deepest + 1);
    force_N.resize(deepest + 1);
  }
};

struct ForceLine {
  double depth_m = 0.0, force_N = 0.0, slope_N_per_m = 0.0;  // through this point
};

// Least squares of force over depth.
std::optional<ForceLine> line_through(std::span<const double> depth_m, std::span<const double> force_N,
                                      std::size_t begin, std::size_t end) {
  const auto n = static_cast<double>(end - begin);
  ForceLine line;
  for (std::size_t i = begin; i < end; ++i) line.depth_m += depth_m[i] / n, line.force_N += force_N[i] / n;
  double dd = 0.0, df = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    const double away_m = depth_m[i] - line.depth_m;
    dd += away_m * away_m, df += away_m * (force_N[i] - line.force_N);
  }
  if (!(dd > 0.0) || !(df > 0.0)) return std::nullopt;
  line.slope_N_per_m = df / dd;
  return line;
}

struct Onset {
  double first_m = 0.0;    // Depth of the first force.
  double surface_m = 0.0;  // Depth to which the force leads back.
  bool is_steep = false;
  bool grows_above = false;  // The force grows from its begin to depth 0.
};

// First row of ten with a force above `clear_N`; the number of rows if there is none.
std::size_t first_pushed(const std::vector<double>& force_N, double clear_N) {
  std::size_t in_a_row = 0;
  for (std::size_t i = 0; i < force_N.size(); ++i) {
    in_a_row = force_N[i] >= clear_N ? in_a_row + 1 : 0;
    if (in_a_row == kIdleRows) return i + 1 - kIdleRows;
  }
  return force_N.size();
}

// The exponent n of F ~ d^n, by least squares of the logarithms, is clearly above that of a cone: by the
// standard errors that the noise of the force gives it.
bool is_too_steep(const Stroke& stroke, std::size_t begin, std::size_t end, double idle_N, double sd_N) {
  std::vector<double> x, y, errors;
  for (std::size_t i = begin; i < end; ++i) {
    const double force_N = stroke.force_N[i] - idle_N;
    if (!(stroke.depth_m[i] > 0.0) || !(force_N > sd_N)) return false;
    x.push_back(std::log(stroke.depth_m[i])), y.push_back(std::log(force_N)),
        errors.push_back(sd_N / force_N);
  }
  const double mean_x = std::reduce(x.begin(), x.end()) / static_cast<double>(x.size());
  double xx = 0.0, xy = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double away = x[i] - mean_x;
    xx += away * away, xy += away * y[i], variance += away * away * errors[i] * errors[i];
  }
  return xx > 0.0 && xy - kOnsetClear * std::sqrt(variance) > kSteepest * xx;
}

// True if the force grows from `first` to depth 0. Drift, or a mass below the cell that accelerates, stays
// level.
bool grows_above(const Stroke& stroke, std::size_t first, double idle_N) {
  constexpr double kGrowth = 2.0;  // A line grows fivefold from the first to the last third, a drift hardly.
  std::size_t end = first;
  while (end < stroke.depth_m.size() && stroke.depth_m[end] < 0.0) ++end;
  const std::size_t third = (end - first) / 3;
  if (third == 0) return false;
  double begin_N = 0.0, end_N = 0.0;
  for (std::size_t i = 0; i < third; ++i) {
    begin_N += stroke.force_N[first + i] - idle_N;
    end_N += stroke.force_N[end - 1 - i] - idle_N;
  }
  return end_N > kGrowth * begin_N;
}

// The first force that is clear of its noise; its line, down to where the force is clear of that first one by
// the same factor, leads back to the surface. Empty if the recording does not begin in air.
std::optional<Onset> onset_of(const Stroke& stroke) {
  constexpr std::size_t kFewestOfLine = 5;
  const auto& force = stroke.force_N;
  if (force.size() < 3 * kIdleRows) return std::nullopt;
  double idle_N = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < kIdleRows; ++i) idle_N += force[i] / static_cast<double>(kIdleRows);
  for (std::size_t i = 0; i < kIdleRows; ++i) squares += (force[i] - idle_N) * (force[i] - idle_N);
  const std::span<const double> begin(force.data(), 3 * kIdleRows);
  double sd_N = std::max(noise_of_bends(begin), std::sqrt(squares / static_cast<double>(kIdleRows - 1)));
  // One value in all of these rows (a threshold, a sample that was held) shows no noise.
  if (!(sd_N > 0.0)) sd_N = noise_of_bends(force);
  const double clear_N = kOnsetClear * sd_N;
  const std::size_t first = first_pushed(force, idle_N + clear_N);
  std::size_t end = first;
  while (end < force.size() && force[end] - idle_N < kOnsetClear * clear_N) ++end;
  end = std::max(end, first + kFewestOfLine);
  if (first <= kIdleRows || end >= force.size()) return std::nullopt;
  const auto line = line_through(stroke.depth_m, force, first, end);
  if (!line || is_loaded_at_start(stroke.depth_m, force, first)) return std::nullopt;
  return Onset{stroke.depth_m[first], line->depth_m - (line->force_N - idle_N) / line->slope_N_per_m,
               is_too_steep(stroke, first, end, idle_N, sd_N), grows_above(stroke, first, idle_N)};
}

// True if a set-up key says that the foot goes into the hole of an earlier push.
bool goes_into_a_hole(const CampaignTrial& trial) {
  constexpr std::string_view kPushes = "pushes_since_preparation";
  return std::ranges::any_of(trial.setup, [&](const SetupEntry& entry) {
    const auto meaning = meaning_of_setup(entry.key);
    const auto* number = std::get_if<double>(&entry.value);
    return number != nullptr && *number > 0.0 &&
           (entry.key == kPushes || (meaning && meaning->key == kPushes));
  });
}

std::string length_text(double m) {
  if (m >= 0.9995) return fmt::format("{:.2f} m", m);
  return fmt::format("{:.{}f} mm", 1e3 * m, m < 9.95e-3 ? 1 : 0);
}

std::string surface_cure(const RecordingPlaces& places, double surface_m) {
  const auto* column = places.column_of("foot_z_m");
  if (column == nullptr) return "count the depth from the surface";
  auto moved = *column;
  moved.offset += surface_m;
  return fmt::format(
      "write {} into [columns], or into columns = {{ … }} of its [[trial]] if the trials differ",
      mapping_line(moved));
}

}  // namespace

bool is_loaded_at_start(std::span<const double> depth_m, std::span<const double> force_N, std::size_t first) {
  constexpr double kAlikeSides = 0.5;  // as in lost_forces.cpp
  const auto before = line_through(depth_m, force_N, 0, first);
  const auto after = line_through(depth_m, force_N, first, std::min(2 * first, force_N.size()));
  if (!before || !after || before->slope_N_per_m < kAlikeSides * after->slope_N_per_m) return false;
  const double rise_N = before->slope_N_per_m * std::abs(depth_m[first - 1] - depth_m[0]);
  return rise_N > kOnsetClear * noise_of_bends(force_N.first(first));
}

double check_surface_onset(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                           const RecordingPlaces& places) {
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  if (campaign.plant != CampaignPlant::intruder || !pushes || any_unusable(recording.findings)) return 0.0;
  if (!recording.has("force_N") || !recording.has("foot_z_m")) return 0.0;
  const auto* belief = std::get_if<IntruderBelief>(&trial.belief);
  const Stroke stroke(recording);
  const auto found = onset_of(stroke);
  if (belief == nullptr || !found || found->surface_m > kHole * stroke.depth_m.back()) return 0.0;
  const double level_m = 2.0 * belief->foot.radius_m * kOutOfLevel;
  const double least_m = std::max(level_m, kOnsetClear * noise_of_bends(stroke.depth_m));
  const bool above = found->first_m < -least_m && found->grows_above;
  const bool below = found->surface_m > least_m && found->is_steep && !goes_into_a_hole(trial);
  if (!above && !below) return 0.0;
  const double apart_m = above ? found->first_m : found->surface_m;
  const auto apart = length_text(std::abs(apart_m));
  add_implausible(
      recording, places, FindingSeverity::note, "foot_z_m",
      above
          ? fmt::format("the force rises {} above depth 0, where nothing should touch the foot. The surface "
                        "seems to be at least {} above depth 0, which shifts every law of depth",
                        apart, apart)
          : fmt::format(
                "the force begins at a depth of {} and grows faster than with the cube of the depth, "
                "faster than for any foot in even ground. The surface seems to be {} below depth 0, or "
                "a layer too soft to measure lies on top",
                apart, apart),
      surface_cure(places, apart_m) +
          "; if the difference grows with the trials' speed, the times of force and depth differ instead");
  return apart_m;
}

}  // namespace sandhopper
