#pragma once
#include <memory>
#include <string>

#include "tools/diagnose/model/plant.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper::diagnose {

// True if the believed foot and links have no mass and the ground is rigid. Nothing but the leg moves then,
// and its force is that of the virtual springs.
bool is_standing_leg(const WorldConfig& world);

// Model of the stance of such a leg. The foot stands still; the recorded angle and command are inputs. The
// ground's force is predicted:
//   F = (tau - n J theta'' - friction + laws) / L'(theta) + m_f g,   n motors
// `channel` is the index of load_cell_force_N among the plant's channels. Null, with `why`, if command,
// angle, phase or force is missing.
std::unique_ptr<TrialModel> standing_leg(const Trial& trial, const Belief& belief, std::uint32_t channel,
                                         std::string& why);

}  // namespace sandhopper::diagnose
