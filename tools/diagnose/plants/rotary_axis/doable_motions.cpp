#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/diagnose/model/sign_smooth.hpp"
#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_figures.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kMotionStep_s = 1e-3;
constexpr double kSmoothing_Hz = 4.0;  // bandwidth of the planned motion: no drive follows a corner
constexpr double kPi = std::numbers::pi;

struct Axis {
  RotaryFigures is;
  double gain = 1.0;  // acting torque over reported torque
  std::vector<const Law*> laws;

  Axis(const Belief& belief, const Edits& edits) : is(belief, edits), laws(edits.at(LawPort::axis)) {
    for (const auto& edit : edits.sensors)
      if (edit.channel == "actuator" && edit.kind == SensorEdit::Kind::gain) gain *= edit.value;
  }

  // Torque on the axis without the drive; `drive_Nm` is the drive's torque that the laws see.
  double passive_Nm(double t_s, double angle, double speed, double drive_Nm) const {
    return sum_of(
               laws,
               AxisState{.time_s = t_s, .angle_rad = angle, .velocity_radps = speed, .torque_Nm = drive_Nm}) -
           is.gravity_torque_Nm * std::sin(angle - is.bottom_rad) - is.viscous_Nm_s * speed -
           is.coulomb_Nm * sign_smooth(speed, is.switch_speed_radps);
  }
};

struct PlannedMotion {
  std::vector<double> angle_rad, speed_radps, torque_Nm;  // reported
};

// Motion that follows a target through a second-order low-pass, with the torque that it needs.
PlannedMotion followed(const Axis& axis, double duration_s, const std::function<double(double)>& target_rad) {
  PlannedMotion m;
  constexpr double kPole = 2.0 * kPi * kSmoothing_Hz;
  double angle = target_rad(0.0), speed = 0.0, drive_Nm = 0.0;
  for (double t = 0.0; t <= duration_s; t += kMotionStep_s) {
    const double accel = kPole * kPole * (target_rad(t) - angle) - 2.0 * kPole * speed;
    drive_Nm = axis.is.inertia_kg_m2 * accel - axis.passive_Nm(t, angle, speed, drive_Nm);
    m.angle_rad.push_back(angle);
    m.speed_radps.push_back(speed);
    m.torque_Nm.push_back(drive_Nm / axis.gain);
    speed += accel * kMotionStep_s;
    angle += speed * kMotionStep_s;
  }
  return m;
}

// Motion of the free axis, released from rest.
PlannedMotion released(const Axis& axis, double duration_s, double from_rad) {
  PlannedMotion m;
  double angle = from_rad, speed = 0.0;
  constexpr int kParts = 20;  // friction near rest is stiff
  for (double t = 0.0; t <= duration_s; t += kMotionStep_s) {
    m.angle_rad.push_back(angle);
    m.speed_radps.push_back(speed);
    m.torque_Nm.push_back(0.0);
    for (int i = 0; i < kParts; ++i) {
      speed += kMotionStep_s / kParts * axis.passive_Nm(t, angle, speed, 0.0) / axis.is.inertia_kg_m2;
      angle += kMotionStep_s / kParts * speed;
    }
  }
  return m;
}

// Largest absolute value of a channel; infinite where it is not recorded.
double largest_of(const std::vector<Trial>& recorded, const char* channel) {
  double most = -1.0;
  for (const auto& trial : recorded)
    if (const auto found = trial.channels.find(channel); found != trial.channels.end())
      for (const double value : found->second)
        if (std::isfinite(value)) most = std::max(most, std::abs(value));
  return most < 0.0 ? std::numeric_limits<double>::infinity() : most;
}

bool is_within(const std::vector<double>& values, double most) {
  return std::ranges::all_of(values, [&](double value) { return std::abs(value) <= most; });
}

// A motion to be planned: a target to follow, or a release if there is no target.
struct Wish {
  std::string profile;  // empty: hold
  std::map<std::string, double> setup;
  std::function<double(double)> target_rad;
};

double triangle(double turns) {  // triangle wave from -1 to 1 with period 1, rising from 0
  return 2.0 / kPi * std::asin(std::sin(2.0 * kPi * turns));
}

std::vector<Wish> wishes(double duration_s, const Reach& reach) {
  // The grid itself if nothing is known of the key. Such motions are then compared with the recorded ones.
  const auto of = [&](const char* key, const std::vector<double>& grid) {
    const auto values = reach.settings(key, grid);
    return values.empty() ? grid : values;
  };
  std::vector<Wish> all;
  for (const double angle : of("position_rad", {0.5, 1.57, 2.4}))
    all.push_back({"", {{"position_rad", angle}}, [=](double) { return angle; }});
  for (const double angle : of("release_position_rad", {0.6, 1.5, 2.4}))
    all.push_back({"release", {{"release_position_rad", angle}}, {}});
  for (const double a : of("amplitude_rad", {0.3, 0.8, 1.5}))
    for (const double f : of("frequency_Hz", {0.3, 0.8, 1.5}))
      all.push_back({"sine", {{"amplitude_rad", a}, {"frequency_Hz", f}}, [=](double t) {
                       return a * std::sin(2.0 * kPi * f * t);
                     }});
  for (const double a : of("amplitude_rad", {0.4, 1.0}))
    all.push_back({"chirp",
                   {{"amplitude_rad", a}, {"frequency_Hz", 0.3}, {"end_frequency_Hz", 2.5}},
                   [=](double t) { return a * std::sin(2.0 * kPi * (0.3 * t + 1.1 * t * t / duration_s)); }});
  for (const double v : of("speed_radps", {0.1, 0.5, 2.0}))
    all.push_back({"ramp", {{"speed_radps", v}, {"amplitude_rad", 1.2}}, [=](double t) {
                     return 1.2 * triangle(t * v / 4.8);
                   }});
  return all;
}

}  // namespace

std::vector<DoableTrial> doable_motions(const std::vector<Trial>& recorded, const Belief& belief,
                                        const Edits& edits, const Reach& reach) {
  std::vector<DoableTrial> trials;
  if (recorded.empty()) return trials;
  double duration_s = 0.0;
  for (const auto& trial : recorded)
    if (!trial.time_s.empty()) duration_s = std::max(duration_s, trial.time_s.back());
  duration_s = std::clamp(duration_s, 2.0, 10.0);
  const Axis axis(belief, edits);
  const double furthest_rad = largest_of(recorded, "position_rad"),
               fastest_radps = largest_of(recorded, "velocity_radps");
  // An axis that no recorded torque drives can only be let go, unless the campaign lists more: a drive is a
  // part. The torque of
  // a free axis is filled in as 0 where it is not recorded.
  const double strongest_recorded_Nm = largest_of(recorded, "torque_Nm");
  const bool is_driven = std::isfinite(strongest_recorded_Nm) && strongest_recorded_Nm > 0.0;
  // Without a stated range (0) the drive can do what it did; beyond that only if numbers are free.
  const double range_Nm = belief.value("sensors.torque_range_Nm");
  const double most_Nm = range_Nm > 0.0                           ? 0.8 * range_Nm
                         : is_driven && !reach.has_free_numbers() ? strongest_recorded_Nm
                                                                  : std::numeric_limits<double>::infinity();
  for (const auto& wish : wishes(duration_s, reach)) {
    if (wish.target_rad && !is_driven && !reach.has_any_part() && !reach.knows(wish.setup.begin()->first))
      continue;
    if (!wish.profile.empty() && !reach.allows("profile", wish.profile)) continue;
    if (!std::ranges::all_of(wish.setup, [&](const auto& e) { return reach.allows(e.first, e.second); }))
      continue;
    const PlannedMotion m = wish.target_rad
                                ? followed(axis, duration_s, wish.target_rad)
                                : released(axis, duration_s, wish.setup.at("release_position_rad"));
    const bool is_known =
        std::ranges::all_of(wish.setup, [&](const auto& e) { return reach.knows(e.first); });
    const bool goes_beyond =
        !is_within(m.angle_rad, furthest_rad) || !is_within(m.speed_radps, fastest_radps);
    if (!is_known && goes_beyond && !reach.has_free_numbers()) continue;
    double strongest_Nm = 0.0;
    for (const double torque : m.torque_Nm) strongest_Nm = std::max(strongest_Nm, std::abs(torque));
    if (!(strongest_Nm < most_Nm)) continue;
    const auto at = [&](const std::vector<double>& values, double t) {
      return values[std::min(values.size() - 1, static_cast<std::size_t>(t / kMotionStep_s + 0.5))];
    };
    DoableTrial one;
    one.belief = belief;
    one.trial = recorded_like(recorded.front(), duration_s, [&](const std::string& channel, double t) {
      return channel == "position_rad"     ? at(m.angle_rad, t)
             : channel == "velocity_radps" ? at(m.speed_radps, t)
             : channel == "torque_Nm"      ? at(m.torque_Nm, t)
                                           : 0.0;
    });
    one.trial.kind = wish.profile.empty() ? "hold" : "motion";
    one.trial.setup = wish.setup;
    one.trial.setup["duration_s"] = std::round(duration_s);
    if (!wish.profile.empty()) one.words["profile"] = wish.profile;
    trials.push_back(std::move(one));
  }
  return trials;
}

}  // namespace sandhopper::diagnose
