#pragma once
#include <memory>

#include "tools/diagnose/model/plant.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {

// A drive that is off still records the noise of its torque sensor, which does not act. If a torque scatters
// by no more than its white noise, it is replaced by its mean, or by 0 if the mean is not significant, and
// the result is true. Otherwise a belief in a smaller torque would always fit better.
bool without_noise_alone(Samples& torque);

// True if the belief describes the speed as an encoder's own estimate.
bool speed_of_encoder(const Belief& belief);

// Model of one motion of an axis, cut into stretches that start at the encoder's reading:
//   J th'' = torque - G sin(th - bottom) - c tanh(th'/v_s) - b th' + laws
std::unique_ptr<TrialModel> make_rotary_trial(const Trial& trial, const Belief& belief, double stretch);

}  // namespace sandhopper::diagnose
