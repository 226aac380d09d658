#include "tools/campaign/surface_check.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "tools/campaign/force_at_depth.hpp"
#include "tools/campaign/implausible.hpp"
#include "tools/campaign/mass_below_cell.hpp"
#include "tools/campaign/surface_onset.hpp"

namespace sandhopper {
namespace {

using enum FindingSeverity;

constexpr std::size_t kFewestAbove = 10, kFewest = 20;
// From so few rows a mean is known no better than one row; then it must be clear beside a single row's noise.
constexpr std::size_t kFewestForZero = 4;
constexpr double kClear = 5.0;         // in standard deviations
constexpr double kShareOfPeak = 0.01;  // A smaller force at no contact changes no stiffness visibly.
constexpr double kLeastTravel_m = 1e-4;
constexpr double kLeastHole_m = 5e-3;

// Force before the first row below the surface.
struct Idle {
  double mean_N = 0.0, sd_N = 0.0;
  std::size_t rows = 0;
};

// Downward acceleration of the foot above the surface.
struct Fall {
  double accel_mps2 = 0.0, sd_mps2 = 0.0;
  bool is_clear() const { return accel_mps2 > kClear * sd_mps2; }
};

struct Push {
  explicit Push(const TrialRecording& recording) {
    ForceAtDepth pairs(recording);
    for (const double z_m : pairs.z_m) depth_m.push_back(-z_m);
    force_N = std::move(pairs.force_N);
    if (recording.has_time) t_s = std::move(pairs.t_s);
  }

  // Least squares of depth = a + b t + 1/2 g t^2 over the rows above the surface.
  std::optional<Fall> fall() const {
    const auto n = static_cast<Eigen::Index>(idle(0.0).rows);
    if (n < static_cast<Eigen::Index>(kFewestAbove) || t_s.empty()) return std::nullopt;
    const Eigen::ArrayXd t = Eigen::Map<const Eigen::ArrayXd>(t_s.data(), n) - t_s.front();
    const Eigen::VectorXd depth = Eigen::Map<const Eigen::VectorXd>(depth_m.data(), n);
    Eigen::MatrixXd by(n, 3);
    by << Eigen::VectorXd::Ones(n), t.matrix(), (0.5 * t.square()).matrix();
    const Eigen::MatrixXd inverse = (by.transpose() * by).inverse();
    const Eigen::VectorXd fitted = inverse * by.transpose() * depth;
    const double variance = (depth - by * fitted).squaredNorm() / static_cast<double>(n - 3);
    return Fall{fitted[2], std::sqrt(variance * inverse(2, 2))};
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

  // Mean force above the surface, without that of a mass below the cell, if it is clearly not zero.
  double untared_N(double mass_below_kg = 0.0) const {
    const Idle air = idle(0.0);
    if (air.rows < kFewestForZero) return 0.0;
    const auto falls = mass_below_kg == 0.0 ? std::nullopt : fall();
    const Fall moves = falls.value_or(Fall{});
    const double rest_N = air.mean_N - mass_below_kg * moves.accel_mps2;
    const double mean_sd_N =
        air.rows < kFewestAbove ? air.sd_N : air.sd_N / std::sqrt(static_cast<double>(air.rows));
    const double error_N = std::hypot(mean_sd_N, mass_below_kg * moves.sd_mps2);
    const bool is_clear = std::abs(rest_N) >= std::max(kClear * error_N, kShareOfPeak * peak_N(air.mean_N));
    return is_clear ? rest_N : 0.0;
  }

  std::vector<double> depth_m, force_N, t_s;  // t_s: empty for a recording without times
};

class SurfaceChecker {
 public:
  SurfaceChecker(TrialRecording& recording, const CampaignTrial& trial, const RecordingPlaces& places)
      : recording_(recording), trial_(trial), places_(places), push_(recording) {}

  void run(double surface_m) {
    if (push_.depth_m.size() < kFewest || check_travel() || check_speed() || check_air()) return;
    if (surface_m >= 0.0) check_zero_of_force();
    if (surface_m == 0.0) check_zero_of_depth();
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

  // A mean speed that no foot of a laboratory has: the time is in a larger unit.
  bool check_speed() {
    constexpr double kFastest_mps = 10.0;  // a free fall from 5 m, as in plausible.cpp
    if (push_.t_s.empty()) return false;
    const auto deepest = std::ranges::max_element(push_.depth_m) - push_.depth_m.begin();
    const double took_s = push_.t_s[static_cast<std::size_t>(deepest)] - push_.t_s.front();
    const double way_m = push_.depth_m[static_cast<std::size_t>(deepest)] - push_.depth_m.front();
    if (!(took_s > 0.0) || way_m <= kFastest_mps * took_s) return false;
    std::string cure = "correct the unit of the time or of the depth";
    if (const auto* time = places_.column_of("t_s"); time != nullptr && !time->in_file)
      cure = fmt::format(
          "if the time is in hours or minutes write t_s = {{ column = {}, unit = \"h\" }} or "
          "\"min\" into [columns], else correct the unit of foot_z_m",
          toml_text(time->column));
    doubt_column(recording_, places_, places_.is_stated("t_s"), "t_s",
                 fmt::format("has {:.3g} s for {:.3g} m of depth, {:.3g} m/s: faster than a fall from 5 m",
                             took_s, way_m, way_m / took_s),
                 std::move(cure));
    return true;
  }

  // Nothing touches the foot above the surface, so a force that varies there as in the bed is of something
  // else: another rig's recording, or exchanged columns.
  bool check_air() {
    constexpr double kAsInBed = 0.5;
    double sums[2] = {}, squares[2] = {}, rows[2] = {};
    for (std::size_t i = 0; i < push_.depth_m.size(); ++i) {
      const int in_bed = push_.depth_m[i] > 0.0 ? 1 : 0;
      sums[in_bed] += push_.force_N[i], squares[in_bed] += push_.force_N[i] * push_.force_N[i];
      ++rows[in_bed];
    }
    if (std::min(rows[0], rows[1]) < static_cast<double>(kFewest)) return false;
    const auto sd = [&](int k) {
      return std::sqrt(std::max(0.0, squares[k] / rows[k] - sums[k] * sums[k] / (rows[k] * rows[k])));
    };
    if (mass_below_cell_kg(trial_.belief, "force_N") != 0.0 || sd(0) < kAsInBed * sd(1)) return false;
    doubt_column(
        recording_, places_, places_.is_stated("force_N"), "force_N",
        fmt::format("varies by {:.3g} N (standard deviation) above the surface and by {:.3g} N below, "
                    "and above it nothing touches the foot: this is not the recording of a press, or "
                    "depth or force is another column",
                    sd(0), sd(1)),
        "name the right file or column, or count the depth from the surface");
    return true;
  }

  void check_zero_of_force() {
    const double mass_kg = mass_below_cell_kg(trial_.belief, "force_N");
    const double untared_N = push_.untared_N(mass_kg);
    if (untared_N == 0.0) return;
    std::string cure = "tare it";
    if (const auto* column = places_.column_of("force_N")) {
      auto tared = *column;
      tared.offset -= untared_N;
      cure = fmt::format("write {} into [columns] if it was not tared", mapping_line(tared));
    }
    const std::string beyond =
        mass_kg == 0.0 ? "" : fmt::format(" beyond the {:.3g} kg below the cell", mass_kg);
    add_implausible(
        recording_, places_, note, "force_N",
        fmt::format("reads {:.3g} N on average above the surface{}, where nothing touches the foot: "
                    "that is in every force at depth, too",
                    untared_N, beyond),
        cure + (mass_kg == 0.0 ? mass_cure(untared_N) : ""));
  }

  // A cell that was tared at rest reads m a while a mass m below it falls with a.
  std::string mass_cure(double force_N) const {
    const auto fall = push_.fall();
    if (!fall || !fall->is_clear() || force_N <= 0.0) return "";
    return fmt::format(
        ". But the foot falls there, with {:.3g} m/s2: a cell that was tared at rest reads as much if {:.2g} "
        "kg hang below it. In that case write \"load_cell.inertia[force_N]\" = {{ mass_kg = {:.2g} }} into "
        "[effects] of nominal.toml, and no offset",
        fall->accel_mps2, force_N / fall->accel_mps2, force_N / fall->accel_mps2);
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
    if (is_loaded_at_start(push_.depth_m, push_.force_N, first)) return;
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
                   const RecordingPlaces& places, double surface_m) {
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  if (campaign.plant != CampaignPlant::intruder || !pushes) return;
  if (!recording.has("force_N") || !recording.has("foot_z_m") || any_unusable(recording.findings)) return;
  SurfaceChecker(recording, trial, places).run(surface_m);
}

}  // namespace sandhopper
