#pragma once
#include "tools/cli/verb.hpp"

namespace sandhopper::cli {

// Registers `hop experiment NAME`; define one constant of this type in experiment_NAME.cpp.
class ExperimentRegistration {
 public:
  explicit ExperimentRegistration(Verb experiment);
};

}  // namespace sandhopper::cli
