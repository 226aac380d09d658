#include "tools/diagnose/plants/intruder/intruder.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/intruder/intruder_motion.hpp"
#include "tools/diagnose/plants/intruder/intruder_trial.hpp"

namespace sandhopper::diagnose {
namespace {

class Intruder final : public PlantModel {
 public:
  std::vector<std::string> channels() const override { return {"force_N"}; }
  std::vector<std::string> phases() const override {
    return {"above_surface", "loading", "hold", "unloading"};
  }

  std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                    std::string& why) const override {
    auto model = make_intruder_trial(trial, belief);
    if (model->rows.size() >= 20) return model;
    why = "needs foot_z_m and force_N";
    return nullptr;
  }

  void describe(const std::vector<Trial>& trials, Context& context) const override {
    double deepest = 0.0, fastest = 0.0, strongest = 0.0;
    for (const auto& trial : trials) {
      const auto z = samples_of(trial, "foot_z_m");
      for (const double v : z.value) deepest = std::max(deepest, -v);
      for (const double v : samples_of(trial, "force_N").value) strongest = std::max(strongest, std::abs(v));
      auto velocity = samples_of(trial, "foot_velocity_mps");
      if (velocity.empty() && z.value.size() > 10) velocity = {z.time_s, smooth(z, 5).rate};
      for (const double v : velocity.value) fastest = std::max(fastest, std::abs(v));
    }
    context.facts.foot_radius_m = context.belief.value("foot.radius_m", 0.04);
    context.facts.depth_m = std::max(deepest, 1e-3);
    context.facts.speed_mps = std::max(fastest, 1e-3);
    context.facts.force_N = std::max(strongest, 0.1);
    // Differences between the set-ups, and the smallest distance of the foot from the floor of the container.
    describe_bed_history(trials, context.facts);
    for (const auto& trial : trials) {
      const double bed_m = trial.setup_or("bed_depth_m", 0.0);
      if (bed_m <= 0.0) continue;
      double lowest = 0.0;
      for (const double v : samples_of(trial, "foot_z_m").value) lowest = std::min(lowest, v);
      const double near_m = std::max(1e-3, bed_m + lowest);
      context.facts.floor_distance_m = std::min(near_m, context.facts.floor_distance_m.value_or(near_m));
    }
    // A trial may push more than once.
    double pushes = 0.0;
    for (const auto& trial : trials) pushes = std::max(pushes, pushes_of(samples_of(trial, "foot_z_m")));
    double& range = context.facts.range_of_pushes;
    range = std::max(range, pushes - 1.0);
    context.facts.most_pushes = std::max(context.facts.most_pushes, range);
    // The foot's position is an input and is not predicted. Its faults are candidates, too.
    context.facts.position_is_out_of_time = position_is_out_of_time(trials);
  }

  std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                  const Edits& /*edits*/, const Reach& reach) const override {
    return doable_intrusions(recorded, belief, reach);
  }

  bool motion_is_prescribed() const override { return true; }
  bool starts_as_believed() const override { return true; }
  bool says_how_trials_differ(const Belief& belief) const override {
    return belief.value("spread.bed_stiffness_relative") > 0.0;
  }
  std::optional<std::size_t> quiet_phase() const override { return kAbove; }
  std::vector<UnsureKey> unsure_keys() const override {
    return {{"unloading line of a stiffer bed", kLineFollows, 0.5}};
  }
  // Measured against another program: 0.007, as if its force sensor were slower by a millisecond.
  double simulations_differ(const std::string& /*port*/) const override { return 0.01; }

  std::vector<FreePort> free_ports(const Context& context) const override {
    return {{"ground.force", false, 0.1 * context.facts.force_N}};
  }
};

}  // namespace

std::unique_ptr<PlantModel> make_intruder() { return std::make_unique<Intruder>(); }

}  // namespace sandhopper::diagnose
