#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tools/experiment/treatments.hpp"

// Runs the treatments under other conditions to find the conditions on which a verdict depends.
namespace sandhopper::paper {

// Mean abs(k_est/k_GT - 1) over seeds and over the cells with a liftoff that `wanted` selects (all if it is
// empty).
std::array<double, kTreatments> cell_error(const CaseResult& result,
                                           const std::function<bool(const HopCell&)>& wanted = {});

// A condition changes one parameter of the estimator, the robot, the bed or the sensors.
struct Condition {
  std::string name;
  std::function<void(CycleConfig&, WorldConfig&)> change;
};
inline constexpr const char* kNoAddedMassForce = "no added-mass force, drag kept";
const std::vector<Condition>& conditions();  // the first changes nothing

struct ConditionResult {
  std::string name;
  std::array<double, kTreatments> penetrating{};   // case A
  std::array<double, kTreatments> to_max_depth{};  // case B
  int seeds = 0;
  int seeds_weighted_better = 0;  // case A: seeds in which weights are better than none
  int strides = 0;
  int incomplete = 0;
};
// `study` gives the number of seeds and trials; its robot and world are the base.
ConditionResult run_condition(const StudySetup& study, const Condition& condition);

}  // namespace sandhopper::paper
