#include "tools/campaign/fall_accel_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/campaign/implausible.hpp"
#include "tools/campaign/integrated_twice.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kAcceleration = "accel_mps2", kFallingHeight = "height_m";
constexpr std::size_t kFewestOfFall = 10;
constexpr double kTimesBetter = 10.0;

// The rows of the fall.
IntegratedTwice flight_of(const TrialRecording& recording) {
  auto flight = integrated_twice(recording, kAcceleration, kFallingHeight);
  if (flight.t_s.empty()) return flight;
  // Up to nine tenths of the rows before it comes near the lowest height: then it lands.
  const auto [low, high] = std::ranges::minmax(flight.position_m);
  const double near = low + 0.05 * (high - low);
  const auto landing = std::ranges::find_if(flight.position_m, [&](double h) { return h < near; });
  const auto rows = static_cast<std::size_t>((landing - flight.position_m.begin()) * 9 / 10);
  flight.t_s.resize(rows), flight.position_m.resize(rows), flight.way_m.resize(rows);
  return flight;
}

// Root mean square of h - sign way + 1/2 g t^2 about its best straight line: start and speed are free.
double misfit(const IntegratedTwice& flight, double sign, double gravity) {
  const auto n = static_cast<double>(flight.t_s.size());
  double st = 0.0, stt = 0.0, sy = 0.0, sty = 0.0, syy = 0.0;
  for (std::size_t i = 0; i < flight.t_s.size(); ++i) {
    const double t = flight.t_s[i] - flight.t_s.front();
    const double y = flight.position_m[i] - sign * flight.way_m[i] + 0.5 * gravity * t * t;
    st += t, stt += t * t, sy += y, sty += t * y, syy += y * y;
  }
  const double stt0 = stt - st * st / n, sty0 = sty - st * sy / n, syy0 = syy - sy * sy / n;
  return stt0 > 0.0 ? std::sqrt(std::max(0.0, syy0 - sty0 * sty0 / stt0) / n) : 0.0;
}

struct Reading {
  double sign;
  bool has_gravity;
  std::string_view what;
};
constexpr std::array kReadings{
    Reading{1.0, false, "the acceleration without gravity (0 at rest)"},
    Reading{-1.0, false, "the acceleration without gravity (0 at rest), counted downward"},
    Reading{-1.0, true, "counted downward"}};

}  // namespace

bool check_fall_acceleration(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                             const RecordingPlaces& places) {
  const auto* belief = std::get_if<FallingBodyBelief>(&trial.belief);
  const bool both = recording.has(kAcceleration) && recording.has(kFallingHeight);
  if (campaign.plant != CampaignPlant::falling_body || belief == nullptr || !both || !recording.has_time)
    return false;
  const auto flight = flight_of(recording);
  const double g = belief->gravity_mps2;
  if (flight.t_s.size() < kFewestOfFall || g < 1.0) return false;
  const double as_read = misfit(flight, 1.0, g);
  const auto fit = [&](const Reading& reading) {
    return misfit(flight, reading.sign, reading.has_gravity ? g : 0.0);
  };
  const auto best = std::ranges::min_element(kReadings, {}, fit);
  if (!(kTimesBetter * fit(*best) < as_read)) return false;
  std::string cure = "correct its sign, or add the gravity";
  if (const auto* column = places.column_of(kAcceleration)) {
    auto right = best->sign < 0.0 ? reversed(*column) : *column;
    if (!best->has_gravity) right.offset += g;
    cure = fmt::format("write {} into [columns]", mapping_line(right));
  }
  doubt_column(recording, places, places.is_stated(kAcceleration) && best->has_gravity, kAcceleration,
               fmt::format("does not go with the height as a specific force does (+9.81 at rest, 0 in free "
                           "fall): integrated twice it is {:.3g} m off, and {:.3g} m as {}",
                           as_read, fit(*best), best->what),
               std::move(cure));
  return true;
}

}  // namespace sandhopper
