#include "tools/campaign/surface_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/campaign/implausible.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

constexpr std::size_t kFewestAbove = 10, kFewest = 20;
constexpr double kClear = 5.0;         // in standard deviations
constexpr double kShareOfPeak = 0.01;  // A smaller force at no contact changes no stiffness visibly.
constexpr double kLeastTravel_m = 1e-4;
constexpr double kLeastHole_m = 5e-3;

// Force before the first row below the surface.
struct Idle {
  double mean_N = 0.0, sd_N = 0.0;
  std::size_t rows = 0;
};

// Depth and force in the rows that have both.
struct Push {
  explicit Push(const TrialRecording& recording) {
    const auto force = recording.channel("force_N"), z = recording.channel("foot_z_m");
    for (std::size_t i = 0; i < z.size(); ++i) {
      if (std::isnan(z[i]) || std::isnan(force[i])) continue;
      depth_m.push_back(-z[i]);
      force_N.push_back(force[i]);
    }
  }

  Idle idle(double above_m) const {
    Idle idle;
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < depth_m.size() && depth_m[i] < above_m; ++i)
      sum += force_N[i], squares += force_N[i] * force_N[i], ++idle.rows;
    if (idle.rows == 0) return idle;
    const auto n = static_cast<double>(idle.rows);
    idle.mean_N = sum / n;
    idle.sd_N = std::sqrt(std::max(0.0, squares / n - idle.mean_N * idle.mean_N));
    return idle;
  }

  double peak_N(double zero_N) const {
    double peak = 0.0;
    for (const double force : force_N) peak = std::max(peak, std::abs(force - zero_N));
    return peak;
  }

  // Mean force above the surface if it is clearly not zero.
  double untared_N() const {
    const Idle air = idle(0.0);
    if (air.rows < kFewestAbove) return 0.0;
    const double error_N = air.sd_N / std::sqrt(static_cast<double>(air.rows));
    const bool is_clear =
        std::abs(air.mean_N) >= std::max(kClear * error_N, kShareOfPeak * peak_N(air.mean_N));
    return is_clear ? air.mean_N : 0.0;
  }

  std::vector<double> depth_m, force_N;
};

class SurfaceChecker {
 public:
  SurfaceChecker(TrialRecording& recording, const CampaignTrial& trial, const RecordingPlaces& places)
      : recording_(recording), trial_(trial), places_(places), push_(recording) {}

  void run() {
    if (push_.depth_m.size() < kFewest || check_travel()) return;
    check_zero_of_force();
    check_zero_of_depth();
  }

 private:
  bool check_travel() {
    const auto [least, most] = std::ranges::minmax(push_.depth_m);
    const double travel_m = most - least;
    if (!(travel_m > 0.0) || travel_m >= kLeastTravel_m) return false;
    const auto* column = places_.column_of("foot_z_m");
    doubt_column(recording_, places_, places_.is_stated("foot_z_m"), "foot_z_m",
                 fmt::format("moves by {:.3g} mm in all, where a foot that is pushed in moves by millimetres",
                             1e3 * travel_m),
                 column == nullptr ? "correct its scale" : scale_cure(*column));
    return true;
  }

  void check_zero_of_force() {
    const double untared_N = push_.untared_N();
    if (untared_N == 0.0) return;
    std::string cure = "tare it";
    if (const auto* column = places_.column_of("force_N")) {
      auto tared = *column;
      tared.offset -= untared_N;
      cure = fmt::format("write {} into [columns] if it was not tared", mapping_line(tared));
    }
    add_implausible(
        recording_, places_, note, "force_N",
        fmt::format("reads {:.3g} N on average above the surface, where nothing touches the foot: "
                    "that is in every force at depth, too",
                    untared_N),
        std::move(cure));
  }

  // Half of the depth: even a cone, whose force grows with the cube of its depth, bears more than the noise
  // there.
  void check_zero_of_depth() {
    if (trial_.number("pushes_since_preparation").value_or(0.0) > 0.0) return;
    const auto deepest = std::ranges::max_element(push_.depth_m);
    const Idle air =
        push_.idle(std::max(push_.depth_m.front() + 0.1 * (*deepest - push_.depth_m.front()), 0.0));
    if (air.rows < kFewestAbove) return;
    const double bears_N = std::max(kClear * air.sd_N, kShareOfPeak * push_.peak_N(air.mean_N));
    std::size_t first = 0;
    while (first < push_.depth_m.size() && push_.force_N[first] - air.mean_N < bears_N) ++first;
    if (first == push_.depth_m.size() || push_.depth_m[first] < std::max(0.5 * *deepest, kLeastHole_m))
      return;
    std::string cure = "count the depth from the surface";
    if (const auto* column = places_.column_of("foot_z_m")) {
      auto moved = *column;
      moved.offset += push_.depth_m[first];
      cure = fmt::format("write {} into [columns]", mapping_line(moved));
    }
    add_implausible(
        recording_, places_, note, "foot_z_m",
        fmt::format("is {:.3g} m below the surface before the bed bears anything: the depth seems to be "
                    "counted from elsewhere, and no law of depth holds; in the hole of an earlier push, "
                    "write pushes_since_preparation = 1",
                    push_.depth_m[first]),
        cure + " if it is counted from elsewhere");
  }

  TrialRecording& recording_;
  const CampaignTrial& trial_;
  const RecordingPlaces& places_;
  const Push push_;
};

}  // namespace

double untared_force_N(const TrialRecording& recording) { return Push(recording).untared_N(); }

void check_surface(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                   const RecordingPlaces& places) {
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  if (campaign.plant != CampaignPlant::intruder || !pushes) return;
  if (!recording.has("force_N") || !recording.has("foot_z_m") || any_unusable(recording.findings)) return;
  SurfaceChecker(recording, trial, places).run();
}

}  // namespace sandhopper
