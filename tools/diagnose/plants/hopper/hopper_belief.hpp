#pragma once
#include "tools/diagnose/model/context.hpp"
#include "tools/diagnose/model/edits.hpp"
#include "tools/diagnose/model/trial.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper::diagnose {

// The belief with what effects change in it: robot, motor, controller, terrain, sensors, spread.
WorldConfig world_of(const Belief& belief, const Edits& edits);

// What the experimenter weighed and put on the body is part of it.
Belief with_payload(Belief belief, const Trial& trial);

}  // namespace sandhopper::diagnose
