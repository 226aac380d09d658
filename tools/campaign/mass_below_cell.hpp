#pragma once
#include <string>
#include <string_view>

#include "tools/campaign/belief.hpp"
#include "tools/campaign/trial_recording.hpp"

// A mass m between a load cell and the ground: the cell reads F - m a, a being the acceleration of the foot.
namespace sandhopper {

// Its label under [effects]: "load_cell.inertia[force_N]".
std::string mass_below_cell_effect(std::string_view channel);

// The mass that nominal.toml states for the cell of this channel; 0: none.
double mass_below_cell_kg(const Belief& belief, std::string_view channel);

// Adds m (s - g) to a hopper's load cell if its mass is stated, s being the specific force of the foot on the
// line between its samples. Rows before the first sample of s and after its last one keep the reading.
void add_mass_below_cell(TrialRecording& recording, const Belief& belief);

}  // namespace sandhopper
