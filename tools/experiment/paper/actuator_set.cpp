#include "tools/experiment/paper/actuator_set.hpp"

#include <cmath>
#include <numbers>

#include "tools/plant/plant.hpp"
#include "tools/plant/trial_draw.hpp"

namespace sandhopper::paper {
namespace {

constexpr std::int64_t kStep_ns = 100'000;
constexpr std::int64_t kRunUp_ns = 20'000'000;  // time in the air at full speed

ActuatorRun drive_once(const WorldConfig& world, const ActuatorSetup& setup, double speed_mps,
                       std::uint64_t seed) {
  const TrialDraw draw(world, {.seed = seed, .noise = true, .start_ns = 0});
  const Bed bed = draw.bed();
  LoadCell cell = draw.load_cell();
  const auto depth_at = [&](std::int64_t time_ns) {
    return speed_mps * 1e-9 * static_cast<double>(time_ns - kRunUp_ns);
  };
  const std::int64_t delay_ns =
      setup.align_amplifier
          ? std::llround(1e9 / (2.0 * std::numbers::pi * world.sensors.load_cell_bandwidth_Hz))
          : 0;
  ActuatorRun run{.speed_mps = speed_mps, .samples = {}};
  std::int64_t seen_ns = 0;
  double deepest_m = 0.0;
  for (std::int64_t now_ns = 0; depth_at(now_ns) < setup.stroke_m; now_ns += kStep_ns) {
    const double depth_m = depth_at(now_ns + kStep_ns);
    const auto reaction = bed.reaction(
        {.depth_m = depth_m, .speed_mps = speed_mps, .max_depth_m = deepest_m, .damping_mass_kg = 0.0});
    deepest_m = depth_m > deepest_m ? depth_m : deepest_m;
    cell.step({.from_ns = now_ns, .to_ns = now_ns + kStep_ns}, reaction.at_acceleration(0.0));
    if (cell.sample().time_ns == seen_ns) continue;
    seen_ns = cell.sample().time_ns;
    const double sampled_depth_m = depth_at(seen_ns - delay_ns);
    if (sampled_depth_m > 0.0) run.samples.push_back({sampled_depth_m, cell.sample().force_N});
  }
  return run;
}

}  // namespace

std::vector<ActuatorRun> run_actuator_set(const WorldConfig& world, const ActuatorSetup& setup) {
  std::vector<ActuatorRun> runs;
  std::uint64_t seed = setup.first_seed;
  for (int i = 1; i <= setup.speeds; ++i)
    for (int trial = 0; trial < setup.trials; ++trial)
      runs.push_back(drive_once(world, setup, i * setup.speed_increment_mps, seed++));
  return runs;
}

}  // namespace sandhopper::paper
