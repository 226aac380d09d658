#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/plants/doable.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kStep_s = 5e-4;
constexpr double kStart_m = -0.01;  // above the surface
constexpr double kRamp_m = 0.006;   // distance to accelerate and to stop
constexpr double kWithdrawal_mps = 0.1;

struct PlannedIntrusion {
  std::vector<double> depth_m, speed_mps, accel_mps2;  // downward

  void put(double speed) {
    const double before = speed_mps.empty() ? 0.0 : speed_mps.back();
    depth_m.push_back((depth_m.empty() ? kStart_m : depth_m.back()) + 0.5 * (before + speed) * kStep_s);
    accel_mps2.push_back((speed - before) / kStep_s);
    speed_mps.push_back(speed);
  }
  // Changes to another speed along half a cosine.
  void change(double to, double duration_s) {
    const double from = speed_mps.empty() ? 0.0 : speed_mps.back();
    const int steps = std::max(2, static_cast<int>(std::lround(duration_s / kStep_s)));
    for (int i = 1; i <= steps; ++i)
      put(from + 0.5 * (to - from) * (1.0 - std::cos(std::numbers::pi * i / steps)));
  }
  void stay(double duration_s) {
    for (double t = 0.0; t < duration_s; t += kStep_s) put(speed_mps.back());
  }
  void go_to(double depth) {
    while ((speed_mps.back() > 0.0) == (depth_m.back() < depth)) put(speed_mps.back());
  }
  void stroke(double speed, double depth, bool withdraw) {
    const double ramp_s = std::min(0.06, 2.0 * kRamp_m / speed);
    change(speed, ramp_s);
    go_to(depth - 0.5 * speed * ramp_s);
    if (!withdraw) return;
    change(0.0, ramp_s);
    stay(0.05);
    change(-kWithdrawal_mps, 0.02);
    go_to(kStart_m);
    change(0.0, 0.02);
  }
};

PlannedIntrusion motion_of(const std::string& profile, double speed, double depth) {
  PlannedIntrusion m;
  m.put(0.0);
  m.stay(0.05);
  if (profile == "cycles")
    for (const double share : {0.6, 0.8, 1.0}) m.stroke(speed, share * depth, true);
  else
    m.stroke(speed, depth, profile != "through");
  return m;
}

// Motion of the rig as recorded, if no set-up states it: the deepest point, and the median over trials of the
// mean speed from the surface to the deepest point of a trial.
struct Stroke {
  double depth_m = 0.04, speed_mps = 0.3;
};
Stroke usual_stroke(const std::vector<Trial>& recorded) {
  Stroke stroke;
  double deepest_m = 0.0;
  std::vector<double> speeds;
  for (const auto& trial : recorded) {
    const auto found = trial.channels.find("foot_z_m");
    if (found == trial.channels.end()) continue;
    double depth_m = 0.0, at_s = 0.0, surface_s = std::nan("");
    for (std::size_t i = 0; i < found->second.size(); ++i) {
      const double z = -found->second[i];
      if (!std::isfinite(z)) continue;
      if (z <= 0.0 && depth_m == 0.0) surface_s = trial.time_s[i];
      if (z > depth_m) {
        depth_m = z;
        at_s = trial.time_s[i];
      }
    }
    deepest_m = std::max(deepest_m, depth_m);
    const double from_s = std::isfinite(surface_s) ? surface_s : trial.time_s.front();
    if (depth_m > 0.0 && at_s > from_s) speeds.push_back(depth_m / (at_s - from_s));
  }
  if (deepest_m > 0.0) stroke.depth_m = deepest_m;
  if (!speeds.empty()) stroke.speed_mps = median(speeds);
  return stroke;
}

}  // namespace

std::vector<DoableTrial> doable_intrusions(const std::vector<Trial>& recorded, const Belief& belief,
                                           const Reach& reach) {
  std::vector<DoableTrial> trials;
  if (recorded.empty()) return trials;
  const Stroke stroke = usual_stroke(recorded);
  const auto depths = extent_of(recorded, "depth_m", stroke.depth_m),
             speeds = extent_of(recorded, "impact_speed_mps", stroke.speed_mps);
  const double radius_m = belief.value("foot.radius_m", 0.04);
  const auto some = [](std::vector<double> values, double otherwise) {
    return values.empty() ? std::vector<double>{otherwise} : values;
  };
  const auto planned_speeds =
      some(reach.settings("impact_speed_mps", {0.02, 0.1, 0.3, 0.6, 1.0}), speeds.high);
  const auto planned_depths = some(reach.settings("depth_m", {0.6 * depths.high, depths.high}), depths.high);
  const auto own_plate_m = 2.0 * radius_m;
  auto plates_m = reach.parts("plate_diameter_m", {0.6 * own_plate_m, 1.5 * own_plate_m});
  std::erase(plates_m, own_plate_m);
  plates_m.insert(plates_m.begin(), own_plate_m);
  for (const char* profile : {"stop_and_withdraw", "cycles", "through"})
    for (const double speed : planned_speeds)
      for (const double depth : planned_depths)
        for (const double plate_m : plates_m) {
          if (!reach.allows("profile", profile)) continue;
          const PlannedIntrusion m = motion_of(profile, speed, depth);
          const double duration_s = kStep_s * static_cast<double>(m.depth_m.size() - 1);
          DoableTrial one;
          one.belief = belief;
          one.belief.numbers["foot.radius_m"] = 0.5 * plate_m;
          const auto at = [&](const std::vector<double>& values, double t) {
            return values[std::min(values.size() - 1, static_cast<std::size_t>(t / kStep_s + 0.5))];
          };
          one.trial = recorded_like(recorded.front(), duration_s, [&](const std::string& channel, double t) {
            return channel == "foot_z_m"            ? -at(m.depth_m, t)
                   : channel == "foot_velocity_mps" ? -at(m.speed_mps, t)
                   : channel == "foot_accel_mps2"   ? -at(m.accel_mps2, t)
                                                    : 0.0;
          });
          one.trial.kind = "intrusion";
          one.trial.setup = {{"impact_speed_mps", speed}, {"depth_m", depth}};
          if (plate_m != own_plate_m) one.trial.setup["plate_diameter_m"] = plate_m;
          one.words["profile"] = profile;
          one.cost = (plate_m != own_plate_m ? 2.0 : 0.0) +
                     0.5 * std::max(0.0, std::log2(speed / std::max(speeds.high, 1e-3))) +
                     (std::string(profile) == "through" ? 0.5 : 0.0);
          trials.push_back(std::move(one));
        }
  return trials;
}

}  // namespace sandhopper::diagnose
