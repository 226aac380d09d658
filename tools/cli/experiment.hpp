#pragma once
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {

// A constant of this type in a file of its own (experiment_NAME.cpp) adds `hop experiment NAME`.
class ExperimentRegistration {
 public:
  explicit ExperimentRegistration(Verb experiment);
};

}  // namespace sandhopper::cli
