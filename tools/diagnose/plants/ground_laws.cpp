#include "tools/diagnose/plants/ground_laws.hpp"

#include <algorithm>

#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

void describe_bed_history(const std::vector<Trial>& trials, PlantFacts& facts) {
  facts.range_of_pushes = range_of_setup(trials, "pushes_since_preparation");
  facts.range_of_wait_s = range_of_setup(trials, "wait_s");
  facts.most_pushes = facts.longest_wait_s = 0.0;
  for (const auto& trial : trials) {
    facts.most_pushes = std::max(facts.most_pushes, trial.setup_or("pushes_since_preparation", 0.0));
    facts.longest_wait_s = std::max(facts.longest_wait_s, trial.setup_or("wait_s", 0.0));
  }
}

GroundLaws::GroundLaws(const Edits& edits, const BedHistory& history)
    : factor_(edits.at(LawPort::ground_factor)),
      static_(edits.at(LawPort::ground_static)),
      unloading_(edits.at(LawPort::ground_unloading)),
      force_(edits.at(LawPort::ground_force)),
      mass_(edits.at(LawPort::ground_mass)),
      tension_(edits.at(LawPort::ground_tension)),
      surface_(edits.at(LawPort::ground_surface)),
      history_(history) {}

double GroundLaws::deeper_m() const {
  if (surface_.empty()) return 0.0;
  return sum_of(surface_, GroundState{.pushes = history_.pushes, .wait_s = history_.wait_s});
}

// Depth of the container's floor below the present surface; 0: unknown.
double GroundLaws::floor_m() const {
  return history_.bed_depth_m > 0.0 ? history_.bed_depth_m + deeper_m() : 0.0;
}

double GroundLaws::quasi_static_N(double curve_N, double depth_m) const {
  if (factor_.empty() && static_.empty()) return curve_N;
  const PortState state = GroundState{.time_s = time_s_,
                                      .depth_m = depth_m,
                                      .pushes = history_.pushes,
                                      .wait_s = history_.wait_s,
                                      .bed_depth_m = floor_m()};
  return curve_N * std::max(0.0, 1.0 + sum_of(factor_, state)) + sum_of(static_, state);
}

double GroundLaws::unloading_factor() const {
  if (unloading_.empty()) return 1.0;
  return std::max(0.0, 1.0 + sum_of(unloading_, GroundState{.time_s = time_s_,
                                                            .pushes = history_.pushes,
                                                            .wait_s = history_.wait_s,
                                                            .bed_depth_m = floor_m()}));
}

BedReaction GroundLaws::added(const BedContact& c, double quasi_static_N, double bearing_N,
                              bool virgin) const {
  const PortState state = GroundState{.time_s = time_s_,
                                      .depth_m = c.depth_m,
                                      .speed_mps = c.speed_mps,
                                      .virgin = virgin ? 1.0 : 0.0,
                                      .quasi_static_N = quasi_static_N,
                                      .bearing_N = bearing_N,
                                      .deepest_m = c.max_depth_m,
                                      .pushes = history_.pushes,
                                      .wait_s = history_.wait_s,
                                      .bed_depth_m = floor_m(),
                                      .since_touch_s = time_s_ - touched_s_};
  return {.force_N = sum_of(force_, state),
          .added_mass_kg = sum_of(mass_, state),
          .least_N = -sum_of(tension_, state)};
}

BedParameters bed_parameters(const Belief& belief, const Edits& edits) {
  BedParameters p;
  BedParameters::fields(p, [&]<class Member>(std::string_view key, Member& member, Range range = {}) {
    const std::string full = "terrain." + std::string(key);
    if constexpr (std::is_same_v<Member, double>) {
      member = std::clamp(edits.edited(full, belief.value(full, member)), range.low, range.high);
    } else {
      member = belief.value(full, member ? 1.0 : 0.0) != 0.0;
    }
  });
  return p;
}

}  // namespace sandhopper::diagnose
