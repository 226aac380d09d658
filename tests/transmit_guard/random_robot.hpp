#pragma once
#include "config/robot_config.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::faults {

// A number from low to high, each decade as likely as the other.
double log_uniform(Random& random, double low, double high);
int whole(Random& random, int low, int high);

// The shipped robot with drives, limits, laws and times drawn at random within what the configuration's own
// checks allow.
RobotConfig random_robot(const RobotConfig& shipped, Random& random);

}  // namespace sandhopper::faults
