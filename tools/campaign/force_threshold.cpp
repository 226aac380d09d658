#include "tools/campaign/force_threshold.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/campaign/signal_noise.hpp"

namespace sandhopper {
namespace {

// As in lost_forces.
constexpr std::size_t kFewestHeld = 20, kNearThreshold = 20;
constexpr double kFarAbove = 8.0, kHeldByChance = 0.001;

struct MeasuredForces {
  double repeats = 1.0, steps = 2.0;  // with one more of each in doubt (rule of succession)
  double squares = 0.0, near = 0.0;   // of the steps of the first measured forces
  double least_N = 0.0;
  std::size_t count = 0;

  double usual_step_N() const { return std::sqrt(squares / near); }
};

MeasuredForces measured_forces(const std::vector<double>& force, double held_N) {
  MeasuredForces out;
  for (std::size_t i = 1; i < force.size(); ++i) {
    if (force[i] == held_N) continue;
    const double above = force[i] - held_N;
    out.least_N = out.count == 0 ? above : std::min(out.least_N, above);
    ++out.count;
    if (force[i - 1] == held_N) continue;
    const double step = force[i] - force[i - 1];
    out.repeats += step == 0.0, out.steps += 1.0;
    if (out.near < static_cast<double>(kNearThreshold)) out.squares += step * step, out.near += 1.0;
  }
  return out;
}

}  // namespace

std::optional<ForceThreshold> force_threshold(const ForceAtDepth& pairs) {
  const auto& force = pairs.force_N;
  if (force.size() < 2 * kFewestHeld) return std::nullopt;
  ForceThreshold out{.held_N = force.front()};
  std::size_t held = 0;
  while (held < force.size() && force[held] == out.held_N) ++held;
  if (held < kFewestHeld || held + kNearThreshold > force.size()) return std::nullopt;
  const auto others = measured_forces(force, out.held_N);
  const double by_chance = static_cast<double>(force.size()) *
                           std::pow(others.repeats / others.steps, static_cast<double>(held - 1));
  out.least_N = others.least_N, out.last_row = pairs.rows[held - 1], out.depth_m = -pairs.z_m[held - 1];
  const bool is_gap = others.near > 0.0 && others.least_N > kFarAbove * others.usual_step_N();
  const bool in_bed = out.depth_m > 5.0 * noise_of_bends(pairs.z_m);
  if (by_chance > kHeldByChance || !is_gap || !in_bed) return std::nullopt;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (force[i] != out.held_N) continue;
    ++out.rows;
    out.depth_m = std::max(out.depth_m, -pairs.z_m[i]);
  }
  return out;
}

}  // namespace sandhopper
