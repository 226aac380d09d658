#pragma once
#include "config/robot_config.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::faults {

// A random number from low to high, with equal probability in each decade.
double log_uniform(Random& random, double low, double high);
int whole(Random& random, int low, int high);

// The shipped robot with random drives, limits, laws and times that pass the configuration's own checks.
RobotConfig random_robot(const RobotConfig& shipped, Random& random);

}  // namespace sandhopper::faults
