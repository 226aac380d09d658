#include "tools/diagnose/plants/rotary_axis/rotary_axis.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "tools/diagnose/discrepancy/balance.hpp"
#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/inputs.hpp"
#include "tools/diagnose/plants/ripple.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_balance.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_figures.hpp"
#include "tools/diagnose/plants/rotary_axis/rotary_trial.hpp"

namespace sandhopper::diagnose {
namespace {

bool is_driven(const std::vector<Trial>& trials) {
  return std::ranges::any_of(trials, [](const Trial& trial) {
    auto torque = samples_of(trial, "torque_Nm");
    without_noise_alone(torque);
    return std::ranges::any_of(torque.value, [](double v) { return v != 0.0; });
  });
}

// Root mean square of the torque on the axis: of the drive; if that is silent, of gravity; if the belief has
// none, of inertia times acceleration.
double torque_that_acts_Nm(const std::vector<Trial>& trials, const Belief& belief) {
  constexpr double kLeast_Nm = 1e-6;
  const RotaryFigures f(belief, {});
  double driven = 0.0, hanging = 0.0, accelerating = 0.0, rows = 0.0, moving = 0.0;
  for (const auto& trial : trials) {
    auto torque = samples_of(trial, "torque_Nm");
    without_noise_alone(torque);
    for (const double v : torque.value) driven += v * v;
    rows += static_cast<double>(torque.value.size());
    const auto positions = averaged(samples_of(trial, "position_rad"), 0.01);
    const auto velocities = averaged(samples_of(trial, "velocity_radps"), 0.01);
    const bool only_speed = positions.value.size() < 20;
    if (only_speed && velocities.value.size() < 20) continue;
    moving += static_cast<double>((only_speed ? velocities : positions).value.size());
    if (!only_speed)
      for (const double p : positions.value)
        hanging += std::pow(f.gravity_torque_Nm * std::sin(p - f.bottom_rad), 2);
    for (const double a : only_speed ? smooth(velocities, 8).rate : smooth(positions, 8).curvature)
      accelerating += std::pow(f.inertia_kg_m2 * a, 2);
  }
  const auto rms = [](double squares, double n) { return n > 0.0 ? std::sqrt(squares / n) : 0.0; };
  for (const double torque : {rms(driven, rows), rms(hanging, moving), rms(accelerating, moving)})
    if (torque > kLeast_Nm) return torque;
  return rows > 0.0 ? kLeast_Nm : 1.0;
}

// Orders of the torque ripple over the angle in the axis' balance, after a regression on friction and drive.
std::vector<double> axis_ripple_orders(const std::vector<Trial>& trials, const Belief& belief,
                                       double fewest) {
  constexpr int kLast = 250;
  constexpr std::size_t kLeastRows = 30;  // per trial
  std::vector<double> angles, torques;
  for (const auto& trial : trials)
    for (const auto& balance : balances_of_axis(trial, belief)) {
      if (balance.rest.size() < kLeastRows) continue;
      const auto rest = rest_without_known(balance);
      torques.insert(torques.end(), rest.begin(), rest.end());
      for (const auto& state : balance.states) angles.push_back(std::get<AxisState>(state).angle_rad);
    }
  if (torques.size() < 100) return {};
  return strongest_orders(angles, torques, static_cast<int>(std::ceil(fewest)), kLast);
}

class RotaryAxis final : public PlantModel {
 public:
  std::vector<std::string> channels() const override { return {"position_rad", "velocity_radps"}; }
  double form_error() const override { return 0.01; }
  std::vector<std::string> phases() const override { return {"rest", "slow", "fast"}; }
  bool phases_are_stages() const override { return false; }
  double unsure_age_s(const std::string& channel, const Belief& belief, double row_s) const override {
    return channel == "velocity_radps" && speed_of_encoder(belief) ? row_s : 0.0;
  }

  // Only of an axis that runs free: the noise of a recorded torque adds up along a stretch, too.
  std::vector<double> stretches(const std::vector<Trial>& trials) const override {
    return is_driven(trials) ? std::vector<double>{1.0} : std::vector<double>{16.0, 4.0, 1.0};
  }
  std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                    std::string& why) const override {
    if (trial.kind == "clamped") {
      why = "the axis is clamped: what only its torque would show is not predicted";
      return nullptr;
    }
    auto model = make_rotary_trial(trial, belief, stretch_);
    if (model->rows.size() >= 20) return model;
    why = "needs position_rad or velocity_radps, and torque_Nm where the axis is driven";
    return nullptr;
  }

  void describe(const std::vector<Trial>& trials, Context& context) const override {
    double speed = 0.0, angle = 0.0, low = 1e9, high = -1e9;
    for (const auto& trial : trials) {
      const auto positions = samples_of(trial, "position_rad");
      for (const double p : positions.value) {
        angle = std::max(angle, std::abs(p));
        low = std::min(low, p);
        high = std::max(high, p);
      }
      const auto velocities = samples_of(trial, "velocity_radps");
      for (const double v : velocities.value) speed = std::max(speed, std::abs(v));
      if (velocities.empty() && positions.value.size() > 10)
        for (const double v : smooth(positions, 5).rate) speed = std::max(speed, std::abs(v));
    }
    context.facts.is_driven = is_driven(trials);
    context.facts.torque_Nm = torque_that_acts_Nm(trials, context.belief);
    context.facts.speed_radps = std::max(speed, 0.1);
    context.facts.angle_rad = std::max(angle, 0.1);
    // An axis that is held still shows no friction: only the noise of the torque would seem to move it.
    constexpr double kMoves = 5.0;  // in switch speeds of the friction
    constexpr double kMostOfTheTime = 0.95;
    double swift = 0.0;
    for (const auto& trial : trials) {
      const auto positions = averaged(samples_of(trial, "position_rad"), 0.01);
      // Steps of a coarse encoder look fast now and then, and so does a noisy speed, so both are averaged
      // first.
      auto rates = positions.value.size() < 20 ? averaged(samples_of(trial, "velocity_radps"), 0.1).value
                                               : smooth(positions, 8).rate;
      if (rates.empty()) continue;
      for (double& rate : rates) rate = std::abs(rate);
      const auto high =
          rates.begin() + static_cast<std::ptrdiff_t>(kMostOfTheTime * static_cast<double>(rates.size()));
      std::nth_element(rates.begin(), high, rates.end());
      swift = std::max(swift, *high);
    }
    context.facts.moves = swift > kMoves * context.belief.value("axis.friction_switch_speed_radps", 0.02);
    context.facts.fewest_ripples = fewest_ripples_over(high - low);
    context.facts.ripple_orders = axis_ripple_orders(trials, context.belief, context.facts.fewest_ripples);
  }

  std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                  const Edits& edits, const Reach& reach) const override {
    return doable_motions(recorded, belief, edits, reach);
  }

  std::vector<Balance> balances(const Trial& trial, const Belief& belief) const override {
    return balances_of_axis(trial, belief);
  }

  std::vector<FreePort> free_ports(const Context& context) const override {
    return {{"axis", false, 0.1 * context.facts.torque_Nm}};
  }
};

}  // namespace

std::unique_ptr<PlantModel> make_rotary_axis() { return std::make_unique<RotaryAxis>(); }

}  // namespace sandhopper::diagnose
