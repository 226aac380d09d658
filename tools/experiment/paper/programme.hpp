#pragma once
#include <functional>
#include <string>
#include <vector>

#include "tools/experiment/paper/force_map.hpp"
#include "tools/experiment/paper/hop_set.hpp"
#include "tools/experiment/paper/sensitivity.hpp"
#include "tools/experiment/treatments.hpp"

// Runs the whole programme of "From Impact to Insight: Dynamics-Aware Proprioceptive Terrain Sensing on
// Granular Media" (arXiv 2604.02563) on the simulator.
namespace sandhopper::paper {

inline constexpr double kGrainDiameter_m = 0.3e-3;

struct ProgrammeSetup {
  CycleConfig cycle{};
  WorldConfig world{};
  ActuatorSetup actuator{};
  int seeds = 8;  // repetitions of the hop set
  int trials_per_cell = 5;
  int condition_seeds = 2;  // seeds for each other condition; 0: no condition is run
  unsigned threads = 2;
  std::function<void(int done, int total)> progress{};  // called from one thread at a time
};

struct ProgrammeResults {
  ProgrammeSetup setup{};
  double inertial_speed_mps = 0.0;  // sqrt(2 d g): below it the force does not depend on speed
  std::vector<ActuatorRun> actuator{};
  ForceMap map{};
  ForceMap map_with_lag{};  // without correction of the load cell's amplifier lag
  StiffnessDefinitions stiffness{};
  std::vector<HopResult> hops{};
  TreatmentStudy treatments{};
  TreatmentStudy without_ages{};              // the same hops, evaluated as if all samples had age zero
  std::vector<ConditionResult> conditions{};  // treatments under other conditions; the first is the base
  HopTrial example{};                         // 1.0 m/s, 3.75 N/cm
  HopTrial quiet{};                           // the same without noise and spread
  HopTrial rigid{};                           // without noise, on a bed a hundred times as stiff
};

ProgrammeResults run_programme(const ProgrammeSetup& setup);

}  // namespace sandhopper::paper
