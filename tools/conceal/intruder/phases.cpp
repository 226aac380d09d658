#include <cmath>

#include "tools/conceal/intruder/world.hpp"

namespace sandhopper::conceal::intruder {
namespace {

constexpr double kHoldSpeed_mps = 1e-3;  // A slower plate is held.

}  // namespace

double surface_m(const World& w, const TrialRandom& trial) {
  return trial.stream("surface").normal(0.0, w.surface_height_spread_m);
}

std::vector<std::string> phases(const World& w, const Setup& setup, const TrialRandom& trial,
                                const Table& recorded) {
  const auto motion = prescribed(w, setup);
  const double surface_height_m = surface_m(w, trial);
  std::vector<std::string> names;
  for (const double t_s : recorded.columns.front().values) {
    const double speed_mps = motion.speed_mps.at(t_s);
    names.emplace_back(motion.depth_m.at(t_s) + surface_height_m <= 0.0 ? "above_surface"
                       : std::abs(speed_mps) < kHoldSpeed_mps           ? "hold"
                       : speed_mps > 0.0                                ? "loading"
                                                                        : "unloading");
  }
  return names;
}

}  // namespace sandhopper::conceal::intruder
