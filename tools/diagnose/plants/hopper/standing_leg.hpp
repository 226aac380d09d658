#pragma once
#include <memory>
#include <string>

#include "tools/diagnose/model/plant.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper::diagnose {

// True where the belief is a leg without mass on rigid ground: no body or foot moves but the
// leg, and its force is that of the virtual springs.
bool is_standing_leg(const WorldConfig& world);

// Stance of such a leg: the foot stands still, the recorded angle moves the leg, the recorded command its
// joint, and the ground answers
//   F = (tau - n J theta'' - friction + laws) / L'(theta) + m_f g,   n motors
// `channel` is the index of load_cell_force_N among the plant's. Null, with `why`, where command, angle,
// phase or force is missing.
std::unique_ptr<TrialModel> standing_leg(const Trial& trial, const Belief& belief, std::uint32_t channel,
                                         std::string& why);

}  // namespace sandhopper::diagnose
