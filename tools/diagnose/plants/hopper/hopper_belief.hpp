#pragma once
#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/trial.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper::diagnose {

// The belief after the edits: robot, motor, controller, terrain, sensors, spread.
WorldConfig world_of(const Belief& belief, const Edits& edits);

// False if nobody states the accelerometers' rate (belief_of_silence): the instant of a sample within its row
// is then not known.
bool imu_rate_is_stated(const Belief& belief);

// The belief with the set-up's payload_kg added to the mass of the body.
Belief with_payload(Belief belief, const Trial& trial);

}  // namespace sandhopper::diagnose
