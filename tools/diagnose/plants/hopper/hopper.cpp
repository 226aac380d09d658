#include "tools/diagnose/plants/hopper/hopper.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/discrepancy/balance.hpp"
#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/fit/statistics.hpp"
#include "tools/diagnose/plants/doable.hpp"
#include "tools/diagnose/plants/hopper/hopper_balance.hpp"
#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_recording.hpp"
#include "tools/diagnose/plants/hopper/hopper_trial.hpp"
#include "tools/diagnose/plants/hopper/recorded_controller.hpp"
#include "tools/diagnose/plants/hopper/standing_leg.hpp"
#include "tools/diagnose/plants/ripple.hpp"

namespace sandhopper::diagnose {
namespace {

// Tolerated delay of one change from compression to extension against its rule (of the median of all:
// kCyclesToSwitch): set by hand.
constexpr double kSwitchFar_s = 6e-3;

double largest_of(const Trial& trial, const std::string& channel) {
  double largest = 0.0;
  for (const double v : samples_of(trial, channel).value) largest = std::max(largest, std::abs(v));
  return largest;
}

// Orders of the torque ripple over the angle in the joint's balance, after a regression on friction and
// drive.
std::vector<double> ripple_orders(const std::vector<Trial>& trials, const Belief& belief) {
  constexpr int kFirst = 12, kLast = 300;  // periods per revolution that are searched
  std::vector<double> angles, torques;
  for (const auto& trial : trials)
    for (const auto& balance : balances_of(trial, with_payload(belief, trial)))
      if (balance.port == "joint") {
        const auto rest = rest_without_known(balance);
        for (std::size_t i = 0; i < rest.size(); ++i) {
          angles.push_back(std::get<AxisState>(balance.states[i]).angle_rad);
          torques.push_back(rest[i]);
        }
      }
  return strongest_orders(angles, torques, kFirst, kLast);
}

class Hopper final : public PlantModel {
 public:
  std::vector<std::string> channels() const override { return hopper_channels(); }
  std::vector<std::string> phases() const override { return hopper_phases(); }
  bool is_costly() const override { return true; }
  bool starts_as_believed() const override { return true; }
  bool says_how_trials_differ(const Belief& belief) const override {
    return std::ranges::any_of(belief.numbers,
                               [](const auto& number) { return number.first.starts_with("spread."); });
  }
  // Measured against another program: up to 0.035 at joint and rail, 0.006 at the ground and in readings.
  double simulations_differ(const std::string& port) const override {
    return port.starts_with("ground") || port == "readings" ? 0.01 : 0.05;
  }
  // Learned by tools/benchmark/learn_port_error.mjs from campaigns of four programs with nothing missing.
  double port_error() const override { return 0.01; }
  bool changes_within_rows() const override { return true; }
  double unsure_age_s(const std::string& channel, const Belief& belief, double row_s) const override {
    if (!channel.starts_with("imu_")) return 0.0;
    return imu_rate_is_stated(belief) ? std::min(row_s, 1.0 / belief.value("sensors.imu_rate_Hz")) : row_s;
  }
  // The current loop may run at 1 kHz, 10 kHz or 40 kHz, or continuously.
  double drive_unsure_s() const override { return 5e-5; }

  std::unique_ptr<TrialModel> trial(const Trial& trial, const Belief& belief,
                                    std::string& why) const override {
    if (!trial.kind.empty() && trial.kind != "hop" && trial.kind != "hold") {
      why = "a trial of kind '" + trial.kind + "' is not simulated: only hops and holds are";
      return nullptr;
    }
    if (is_standing_leg(world_of(belief, {}))) {
      const auto names = channels();
      const auto cell = std::ranges::find(names, "load_cell_force_N") - names.begin();
      return standing_leg(trial, belief, static_cast<std::uint32_t>(cell), why);
    }
    auto model = hopper_trial(trial, belief);
    if (model->rows.size() >= 50) return model;
    why = "needs at least one of motor position, accelerometer, height, load cell or motion capture";
    return nullptr;
  }

  void describe(const std::vector<Trial>& trials, Context& context) const override {
    const WorldConfig world = world_of(context.belief, {});
    double force = 0.0, current = 0.0, fastest = 0.0, low = 1e9, high = -1e9;
    double hottest = kRoom_C;
    for (const auto& trial : trials) {
      force = std::max(force, largest_of(trial, "load_cell_force_N"));
      current = std::max(current, largest_of(trial, "motor_left_current_A"));
      fastest =
          std::max(fastest, std::sqrt(2.0 * world.gravity_mps2 * trial.setup_or("release_height_m", 0.05)));
      for (const double phi : mean_of_motors(trial, "position_rad").value) {
        low = std::min(low, phi);
        high = std::max(high, phi);
      }
      for (const double t : mean_of_motors(trial, "temperature_C").value) hottest = std::max(hottest, t);
    }
    PlantFacts& s = context.facts;
    describe_bed_history(trials, s);
    s.temperature_K = hottest - kRoom_C;
    s.weight_N = (world.robot.leg.body_mass_kg + world.robot.leg.foot_mass_kg) * world.gravity_mps2;
    s.foot_radius_m = world.robot.leg.foot_radius_m;
    s.depth_m = 0.04;
    s.speed_mps = std::max(fastest, 0.1);
    s.force_N = force > 0.0 ? force : 60.0;
    s.torque_Nm = std::max(0.5, 0.5 * current * world.motor.torque_constant_Nm_per_A);
    s.angle_rad = high > low ? high - low : 1.0;
    s.fewest_ripples = fewest_ripples_over(high - low);
    auto orders = ripple_orders(trials, context.belief);
    // The believed cogging may be too small, so its order is a candidate, too.
    const double believed = context.belief.value("robot.cogging_periods_per_rev");
    if (believed > 0.0) orders.insert(orders.begin(), believed);
    s.ripple_orders = std::move(orders);
    s.speed_radps = 10.0;
  }

  std::vector<Balance> balances(const Trial& trial, const Belief& belief) const override {
    if (!trial.kind.empty() && trial.kind != "hop") return {};
    return balances_of(trial, with_payload(belief, trial));
  }

  // The recorded phases are imposed on the simulation, so no fit can show that one began too late or too
  // early.
  std::vector<BrokenRule> broken_rules(const std::vector<Trial>& trials,
                                       const std::vector<Belief>& beliefs) const override {
    std::vector<double> late_s;
    double off_s = 0.0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (!trials[i].kind.empty() && trials[i].kind != "hop") continue;
      const WorldConfig world = world_of(beliefs[i], {});
      off_s = std::max(off_s, kCyclesToSwitch / world.controller.rate_Hz);
      for (const double late : late_switches_s(trials[i], world)) late_s.push_back(late);
    }
    if (late_s.empty()) return {};
    std::vector<double> far_s;
    for (const double late : late_s)
      if (std::abs(late) > kSwitchFar_s) far_s.push_back(late);
    const bool some = far_s.size() >= 2 && 10 * far_s.size() >= late_s.size();
    const bool all = late_s.size() >= kTooFewTrials && std::abs(median(late_s)) > off_s;
    if (!some && !all) return {};
    const auto& shown = all ? late_s : far_s;
    const auto [low, high] = std::ranges::minmax(shown);
    return {{.id = "controller.not_as_configured",
             .port = Port::controller,
             .statement = "The controller begins to push off at another time than its rule says.",
             .equation = "t_switch -> t_switch + t_late",
             .parameter = "switch_late_s",
             .value = median(shown),
             .low = low,
             .high = high}};
  }

  std::vector<DoableTrial> doable(const std::vector<Trial>& recorded, const Belief& belief,
                                  const Edits& edits, const Reach& reach) const override {
    return doable_hops(recorded, belief, edits, reach);
  }

  std::vector<FreePort> free_ports(const Context& context) const override {
    return {{"rail", false, 0.05 * context.facts.weight_N},
            {"joint", false, 0.05 * context.facts.torque_Nm, true},
            {"ground.force", false, 0.1 * context.facts.force_N, true},
            {"actuator", true, 0.1 * context.facts.torque_Nm}};
  }
};

}  // namespace

std::unique_ptr<PlantModel> make_hopper() { return std::make_unique<Hopper>(); }

}  // namespace sandhopper::diagnose
