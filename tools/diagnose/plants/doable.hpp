#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/diagnose/model/plant.hpp"

// Trials that could be done, for the choice of the next one.
namespace sandhopper::diagnose {

// Rows of `duration_s` as the campaign's recorder writes them: the channels, rates and empty cells of
// `sample`, each value from `value(channel, time)`.
Trial recorded_like(const Trial& sample, double duration_s,
                    const std::function<double(const std::string& channel, double time_s)>& value);

// Lowest and highest value of a set-up's key over the recorded trials; `otherwise` where none has it.
struct Extent {
  double low = 0.0, high = 0.0;
};
Extent extent_of(const std::vector<Trial>& recorded, const std::string& key, double otherwise);

std::vector<DoableTrial> doable_drops(const PlantModel& plant, const std::vector<Trial>& recorded,
                                      const Belief& belief, const Edits& edits, const Reach& reach);
// Motions that take the axis no further and no faster than it went, where the set-up's keys are not in reach.
std::vector<DoableTrial> doable_motions(const std::vector<Trial>& recorded, const Belief& belief,
                                        const Edits& edits, const Reach& reach);
std::vector<DoableTrial> doable_intrusions(const std::vector<Trial>& recorded, const Belief& belief,
                                           const Reach& reach);
// Hops of the first stride: release heights in reach, and leg stiffnesses, which are only a number in the
// robot.
std::vector<DoableTrial> doable_hops(const std::vector<Trial>& recorded, const Belief& belief,
                                     const Edits& edits, const Reach& reach);

}  // namespace sandhopper::diagnose
