#include "tools/diagnose/plants/falling_body/falling_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/falling_body/falling_body_recording.hpp"
#include "tools/diagnose/plants/falling_body/falling_simulation.hpp"
#include "tools/diagnose/plants/falling_body/falling_trial.hpp"
#include "tools/diagnose/plants/inputs.hpp"

namespace sandhopper::diagnose {
namespace {

// Standard deviation of the condition that the simulated fall ends at the fitted touchdown.
constexpr double kTouchdownAgrees_s = 1e-4;
constexpr double kGoesBothWays = 0.1;  // share of a body's way, of the part up and of the part down
constexpr double kSinks = 0.5;         // share of the free-fall speed, below which the body sinks slowly

// True if a body goes up by more than a tenth of its way before it comes down.
bool rises_and_falls(const Samples& heights) {
  if (heights.empty()) return false;
  const auto [low, high] = std::ranges::minmax(heights.value);
  return high - heights.value.front() > kGoesBothWays * (high - low) &&
         high - heights.value.back() > kGoesBothWays * (high - low);
}

class FallingBody final : public PlantModel {
 public:
  std::vector<std::string> channels() const override { return {"height_m", "accel_mps2", "touchdown_s"}; }
  double form_error() const override { return 1e-3; }
  double least_sd(const std::string& channel) const override {
    return channel == "touchdown_s" ? kTouchdownAgrees_s : 0.0;
  }
  std::vector<std::string> phases() const override {
    return {"held", "slow_fall", "fast_fall", "bed", "entry", "immersed"};
  }
  bool phases_are_stages() const override { return false; }

  std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                    std::string& why) const override {
    auto model = make_falling_trial(trial, belief);
    if (model->rows.size() >= 10) return model;
    why = "fewer than 10 samples of height_m and accel_mps2";
    return nullptr;
  }

  void describe(const std::vector<Trial>& trials, Context& context) const override {
    const auto& b = context.belief;
    const double g = b.value("gravity_mps2", 9.81);
    double longest_s = 0.0, seen_mps = 0.0;
    for (const auto& trial : trials) {
      if (!trial.time_s.empty()) longest_s = std::max(longest_s, trial.time_s.back());
      const auto heights = samples_of(trial, "height_m");
      seen_mps = std::max(seen_mps, fastest_mps(heights));
      context.facts.rises_and_falls = context.facts.rises_and_falls || rises_and_falls(heights);
    }
    double drop_m = 0.0;
    if (const auto it = context.channels.find("height_m"); it != context.channels.end())
      drop_m = it->second.high - it->second.low;
    double speed = drop_m > 0.0 ? std::sqrt(2.0 * g * drop_m) : g * longest_s;
    // A body that sinks slowly never reaches the free-fall speed.
    if (seen_mps > 0.0 && seen_mps < kSinks * speed) speed = seen_mps;
    if (std::ranges::any_of(trials, [&](const Trial& trial) { return meets_a_liquid(trial, b); }))
      context.facts.wetted_over_m = body_length_m(b);
    context.facts.weight_N = b.value("body.mass_kg", 1.0) * g;
    context.facts.speed_mps = std::max(speed, 0.1);
    context.facts.masses_differ = range_of_setup(trials, "mass_kg") > 0.0;
    if (b.value("bed.stiffness_N_per_m") > 0.0) {
      context.facts.depth_m = std::max(
          0.01, std::abs(speed) * std::sqrt(b.value("body.mass_kg", 1.0) / b.value("bed.stiffness_N_per_m")));
      context.facts.foot_radius_m =
          std::max(0.01, std::sqrt(b.value("body.frontal_area_m2") / std::numbers::pi));
    }
  }

  std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                  const Edits& edits, const Reach& reach) const override {
    return doable_drops(*this, recorded, belief, edits, reach);
  }

  std::vector<FreePort> free_ports(const Context& context) const override {
    return {{"body", false, 0.1 * context.facts.weight_N}};
  }
};

}  // namespace

std::unique_ptr<PlantModel> make_falling_body() { return std::make_unique<FallingBody>(); }

}  // namespace sandhopper::diagnose
