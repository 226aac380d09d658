#include "tools/terrain/rigid_ground.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimation/leg.hpp"
#include "terrain/profile_config.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/report/digits.hpp"
#include "tools/terrain/figure_text.hpp"
#include "tools/terrain/leg_regression.hpp"
#include "tools/terrain/mean_json.hpp"

namespace sandhopper {
namespace {

constexpr double kContact_N = 10.0;  // the same as in LegIdentificationOptions
constexpr double kGreatestAmplification = 2.0;

// Downward speed of the body at this row of the plate, if position and speed at the end of the record equal
// those at its start.
double falling_speed_mps(const LegHop& hop, double tare_N, double mass_kg, std::size_t row) {
  const auto& t = hop.reference_t_s;
  double speed = 0.0, way = 0.0, at_row = 0.0;  // upward, from the first reading on
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double step_s = t[i] - t[i - 1];
    const double force_N = 0.5 * (hop.reference_N[i] + hop.reference_N[i - 1]) - tare_N;
    const double before = speed;
    speed += (force_N / mass_kg - kGravity_mps2) * step_s;
    way += 0.5 * (before + speed) * step_s;
    if (i == row) at_row = speed;
  }
  return way / (t.back() - t.front()) - at_row;
}

// Rate of change of the leg's length over the last 10 ms before this time.
double extension_mps(const LegHop& hop, double t_s) {
  constexpr double kBefore_s = 0.010;
  const auto last = std::lower_bound(hop.t_s.begin(), hop.t_s.end(), t_s) - hop.t_s.begin();
  const auto first = std::lower_bound(hop.t_s.begin(), hop.t_s.end(), t_s - kBefore_s) - hop.t_s.begin();
  if (last - first < 2) return 0.0;
  const Leg leg = bare_leg(hop.leg);
  const auto a = static_cast<std::size_t>(first), b = static_cast<std::size_t>(last - 1);
  return (leg.kinematics(hop.angle_rad[b]).length_m - leg.kinematics(hop.angle_rad[a]).length_m) /
         (hop.t_s[b] - hop.t_s[a]);
}

std::optional<BlowBound> bound_of(const LegHop& hop, double tare_N, double mass_kg) {
  const auto& t = hop.reference_t_s;
  const auto force_N = [&](std::size_t i) { return hop.reference_N[i] - tare_N; };
  constexpr double kStanding = 0.25;  // the same criterion as in leg_regression.cpp for a hop that starts in
                                      // contact
  if (t.empty() || force_N(0) > kStanding * kContact_N) return std::nullopt;
  std::size_t contact = 0;
  while (contact < t.size() && force_N(contact) < kContact_N) ++contact;
  if (contact == 0 || contact == t.size()) return std::nullopt;
  // Go back to the reading from which the force only rises, because on soft ground 10 N are reached late.
  while (contact > 1 && force_N(contact - 1) > 0.0 && force_N(contact - 1) < force_N(contact)) --contact;
  std::size_t peak = contact;
  while (peak + 1 < t.size() && force_N(peak + 1) > force_N(peak)) ++peak;
  BlowBound bound{.trial = hop.trial, .peak_N = force_N(peak), .rise_s = t[peak] - t[contact - 1]};
  bound.speed_mps = falling_speed_mps(hop, tare_N, mass_kg, contact - 1) +
                    std::max(extension_mps(hop, t[contact - 1]), 0.0);
  if (!(bound.speed_mps > 0.0)) return std::nullopt;
  bound.depth_m = bound.speed_mps * bound.rise_s;
  bound.stiffness_N_per_m = bound.peak_N / (kGreatestAmplification * bound.depth_m);
  return bound;
}

}  // namespace

double stiffest_granular_N_per_m() {
  const ProfileConfig prior;
  return prior.believed_stiffness_N_per_m * (1.0 + 1.959964 * prior.stiffness_spread_relative);
}

RigidGround rigid_ground(std::span<const LegHop> hops, double tare_N, double mass_kg) {
  RigidGround out;
  std::vector<double> bounds;
  for (const auto& hop : hops)
    if (auto bound = bound_of(hop, tare_N, mass_kg)) {
      bounds.push_back(bound->stiffness_N_per_m);
      out.landings.push_back(std::move(*bound));
    }
  if (bounds.size() > 1) out.at_least_N_per_m = std::max(mean_over_trials(bounds).ci95_low, 0.0);
  return out;
}

namespace {

// Rounded down, so that the ground is at least as stiff as the text says.
double two_digits_below(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return unit * std::floor(value / unit);
}

}  // namespace

std::string rigid_answer(const RigidGround& ground) {
  if (!(ground.at_least_N_per_m > 0.0))
    return "Nothing here bounds the stiffness of the ground: no landing on the plate.";
  double depth_m = 0.0;
  for (const auto& landing : ground.landings) depth_m = std::max(depth_m, landing.depth_m);
  return fmt::format(
      "The ground is {}: at least {} N/m ({} landings, in which the foot can have gone in by {:.1f} mm at "
      "most "
      "when the blow was greatest).",
      ground.rigid() ? "rigid" : "not shown to be rigid",
      plain_number(two_digits_below(ground.at_least_N_per_m), 2), ground.landings.size(), 1e3 * depth_m);
}

nlohmann::ordered_json rigid_json(const RigidGround& ground) {
  return {{"rigid", ground.rigid()},
          {"stiffness_N_per_m", nullptr},
          {"at_least_N_per_m", number_or_null(ground.at_least_N_per_m)},
          {"rigid_above_N_per_m", stiffest_granular_N_per_m()},
          {"landings", ground.landings.size()}};
}

StudyTable rigid_table(const RigidGround& ground) {
  StudyTable table{.title = "Lower bounds of the ground's stiffness from the blow of each landing",
                   .columns = {"hop", "peak, N", "rise, ms", "speed, m/s", "depth at most, mm",
                               "stiffness at least, N/m"}};
  for (const auto& l : ground.landings)
    table.rows.push_back({trial_label(l.trial), figure_number(l.peak_N),
                          fmt::format("{:.2f}", 1e3 * l.rise_s), fmt::format("{:.2f}", l.speed_mps),
                          fmt::format("{:.2f}", 1e3 * l.depth_m), figure_number(l.stiffness_N_per_m)});
  table.note = fmt::format(
      "Depth: speed times rise, from the last reading before contact to the peak. Stiffness: half the peak "
      "(a "
      "plate without damping shows twice a sudden force) over that depth; the answer is the lower 95 % limit "
      "of "
      "the mean over hops. Ground is called rigid above {} N/m, the stiffest granular bed that the strength "
      "profile's prior expects. No depth of the foot was recorded, so there is no profile.",
      figure_number(stiffest_granular_N_per_m()));
  return table;
}

}  // namespace sandhopper
