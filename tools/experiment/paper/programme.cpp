#include "tools/experiment/paper/programme.hpp"

#include <cmath>

namespace sandhopper::paper {
namespace {

constexpr std::size_t kExampleCell = 10;  // 1.0 m/s, 3.75 N/cm
constexpr double kRigidFactor = 100.0;

}  // namespace

ProgrammeResults run_programme(const ProgrammeSetup& setup) {
  ProgrammeResults r{.setup = setup};
  const auto& world = setup.world;
  r.inertial_speed_mps = std::sqrt(2.0 * kGrainDiameter_m * world.gravity_mps2);

  r.actuator = run_actuator_set(world, setup.actuator);
  r.map = fit_force_map(r.actuator);
  ActuatorSetup as_it_is = setup.actuator;
  as_it_is.align_amplifier = false;
  r.map_with_lag = fit_force_map(run_actuator_set(world, as_it_is));
  r.stiffness =
      stiffness_by_definition(r.actuator, r.map, world.terrain.stiffness_N_per_m, r.inertial_speed_mps);

  // The hop set is run once for its shapes and errors, once for the treatments, and again for every other
  // condition.
  const int strides = setup.seeds * static_cast<int>(hop_cells().size()) * setup.trials_per_cell;
  const int per_condition =
      setup.condition_seeds * static_cast<int>(hop_cells().size()) * setup.trials_per_cell;
  const int total = 3 * strides + per_condition * static_cast<int>(conditions().size());
  const auto from = [&](int before) {
    return [&setup, before, total](int done, int) {
      if (setup.progress) setup.progress(before + done, total);
    };
  };
  r.hops = run_hop_set({.cycle = setup.cycle,
                        .world = world,
                        .seeds = setup.seeds,
                        .trials_per_cell = setup.trials_per_cell,
                        .threads = setup.threads,
                        .progress = from(0)},
                       r.map);
  StudySetup study{.cycle = setup.cycle,
                   .world = world,
                   .seeds = setup.seeds,
                   .trials_per_cell = setup.trials_per_cell,
                   .threads = setup.threads,
                   .progress = from(strides)};
  r.treatments = run_treatment_study(study);
  study.ignore_ages = true;
  study.progress = from(2 * strides);
  r.without_ages = run_treatment_study(study);
  study.ignore_ages = false;
  study.seeds = setup.condition_seeds;
  for (std::size_t i = 0; setup.condition_seeds > 0 && i < conditions().size(); ++i) {
    study.progress = from(3 * strides + static_cast<int>(i) * per_condition);
    r.conditions.push_back(run_condition(study, conditions()[i]));
  }

  const auto& cell = hop_cells()[kExampleCell];
  r.example = run_hop(setup.cycle, world, cell, {.seed = 1});
  r.quiet = run_hop(setup.cycle, world, cell, {.noise = false});
  WorldConfig rigid = world;
  rigid.terrain.stiffness_N_per_m *= kRigidFactor;
  r.rigid = run_hop(setup.cycle, rigid, cell, {.noise = false});
  return r;
}

}  // namespace sandhopper::paper
