#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/diagnose/model/plant.hpp"

// Possible next trials of each plant; the next one is chosen among them.
namespace sandhopper::diagnose {

// A trial of `duration_s` with the channels, rates and empty cells of the recorded trial `sample`. Its values
// come from `value(channel, time)`.
Trial recorded_like(const Trial& sample, double duration_s,
                    const std::function<double(const std::string& channel, double time_s)>& value);

// Lowest and highest value of a set-up key over the recorded trials; `otherwise` for both if no trial has it.
struct Extent {
  double low = 0.0, high = 0.0;
};
Extent extent_of(const std::vector<Trial>& recorded, const std::string& key, double otherwise);

// Drops over release height, release speed and payload, simulated with `edits`.
std::vector<DoableTrial> doable_drops(const PlantModel& plant, const std::vector<Trial>& recorded,
                                      const Belief& belief, const Edits& edits, const Reach& reach);
// Motions of a rotary axis, simulated with `edits`. If a set-up key is neither listed nor recorded, only
// motions within the recorded angles and speeds, unless numbers are free.
std::vector<DoableTrial> doable_motions(const std::vector<Trial>& recorded, const Belief& belief,
                                        const Edits& edits, const Reach& reach);
// Intrusions over profile, speed, depth and plate. Only the motion is planned: force_N is 0.
std::vector<DoableTrial> doable_intrusions(const std::vector<Trial>& recorded, const Belief& belief,
                                           const Reach& reach);
// First strides over release height and leg stiffness, simulated with `edits`. Any stiffness that the
// campaign does not exclude is in reach, because it is only a parameter of the robot.
std::vector<DoableTrial> doable_hops(const std::vector<Trial>& recorded, const Belief& belief,
                                     const Edits& edits, const Reach& reach);

}  // namespace sandhopper::diagnose
