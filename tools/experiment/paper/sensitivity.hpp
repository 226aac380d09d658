#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tools/experiment/treatments.hpp"

// The treatments under other conditions: on which of them a verdict hangs.
namespace sandhopper::paper {

// Mean abs(k_est/k_GT - 1) over seeds and over the cells that `wanted` picks (all, when empty) and that have
// a liftoff.
std::array<double, kTreatments> cell_error(const CaseResult& result,
                                           const std::function<bool(const HopCell&)>& wanted = {});

// One figure of the estimator, the robot, the bed or the sensors changed.
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
  int seeds_weighted_better = 0;  // case A: weights better than none
  int strides = 0;
  int incomplete = 0;
};
// `study` says how many seeds and trials; its robot and world are the base.
ConditionResult run_condition(const StudySetup& study, const Condition& condition);

}  // namespace sandhopper::paper
