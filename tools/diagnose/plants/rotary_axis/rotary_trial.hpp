#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

// A drive that is off records its torque sensor's noise, which acts on nothing: where a torque scatters no
// more than its white noise does, its mean stands for it, or zero where that is noise, too, and the result is
// true. Otherwise a belief in less torque would always fit better.
bool without_noise_alone(Samples& torque);

// True if the speed is an encoder's own estimate, not of whatever else measures it.
bool speed_of_encoder(const Belief& belief);

// One motion of an axis, cut into stretches that begin where the encoder says:
//   J th'' = torque - G sin th - c tanh(th'/v_s) - b th' + laws
std::unique_ptr<TrialModel> make_rotary_trial(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
