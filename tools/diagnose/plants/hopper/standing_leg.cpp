#include "tools/diagnose/plants/hopper/standing_leg.hpp"

#include <algorithm>
#include <cmath>

#include "tools/diagnose/plants/hopper/hopper_belief.hpp"
#include "tools/diagnose/plants/hopper/hopper_recording.hpp"

namespace sandhopper::diagnose {
namespace {

constexpr double kGrid_s = 1e-3;
constexpr double kRow_s = 2.5e-3;         // rows of the force: the ringing of the force plate is averaged
constexpr double kSmoothing_s = 0.010;    // smoothing of the angle, to each side
constexpr double kSettling_s = 0.015;     // after a landing, unless the set-up states contact_settling_s
constexpr double kOffset_N = 0.5;         // least standard deviation of the force's zero
constexpr double kInTheAir_N = 5.0;       // below this force the foot is in the air
constexpr double kFlightBegins_s = 0.03;  // the foot is in the air this long after the controller's liftoff
constexpr double kFrictionSwitch_radps = 0.2;  // dry friction changes its sign within this speed
constexpr const char* kForce = "load_cell_force_N";
enum Phase : std::uint32_t { kCompression = 2, kExtension = 4 };

class StandingLeg final : public TrialModel {
 public:
  StandingLeg(const Trial& trial, const Belief& belief, std::uint32_t channel) : belief_(belief) {
    name = trial.name;
    const auto angle = mean_of_motors(trial, "position_rad");
    const auto command = commands_of(trial);
    const auto force = averaged(samples_of(trial, kForce), kRow_s);
    const auto phase = samples_of(trial, "phase");
    if (angle.value.size() < 20 || command.empty() || force.value.size() < 20 || phase.empty()) return;
    take_motion(angle, command);
    const auto [from_s, to_s] = stance(trial, phase, force);
    for (std::size_t i = 0; i < force.value.size(); ++i) {
      const double t = force.time_s[i];
      if (t < from_s || t > to_s) continue;
      times_.push_back(t);
      rows.push_back({channel, 0, rate_.at(t) > 0.0 ? kCompression : kExtension, t, force.value[i]});
    }
    const double offset = belief.value("spread.load_cell_offset_N");
    trial_nuisances = {{"load_cell_offset_N", std::max(offset, kOffset_N), 0.05}};
    label_rows();
  }

  void predict(const Edits& edits, std::span<const double> nuisances, std::span<double> out) const override {
    const WorldConfig world = world_of(belief_, edits);
    const Leg leg(world.robot.leg);
    const double motors = world.robot.leg.motor_count;
    const auto laws = edits.at(LawPort::joint);
    const Signal torque = acting_torque(edits);
    const double offset_rad = offset_of_encoder(edits);
    Signal force = angle_;
    for (std::size_t i = 0; i < force.values.size(); ++i) {
      const double theta = angle_.values[i] - offset_rad, rate = rate_.values[i];
      double joint_Nm = torque.values[i] -
                        motors * world.robot.leg.rotor_inertia_kg_m2 * acceleration_.values[i] -
                        motors * world.robot.joint_coulomb_Nm * std::tanh(rate / kFrictionSwitch_radps);
      if (!laws.empty())
        joint_Nm += sum_of(laws, AxisState{.time_s = kGrid_s * static_cast<double>(i),
                                           .angle_rad = theta,
                                           .velocity_radps = rate,
                                           .torque_Nm = torque.values[i]});
      force.values[i] = joint_Nm / leg.kinematics(theta).dlength_m_per_rad +
                        world.robot.leg.foot_mass_kg * world.gravity_mps2;
    }
    observe(force, sensor_belief(belief_, "load_cell", "N"), edits, kForce, times_, out);
    for (double& f : out) f += nuisances[0];
  }

 private:
  void take_motion(const Samples& angle, const Samples& command) {
    const auto half =
        static_cast<std::size_t>(std::clamp(kSmoothing_s / median_step_s(angle.time_s), 3.0, 20.0));
    const Smoothed at = smooth(angle, half);
    const auto count = static_cast<std::size_t>(angle.time_s.back() / kGrid_s) + 2;
    angle_ = on_grid({angle.time_s, at.value}, 0.0, kGrid_s, count, false);
    rate_ = on_grid({angle.time_s, at.rate}, 0.0, kGrid_s, count, false);
    acceleration_ = on_grid({angle.time_s, at.curvature}, 0.0, kGrid_s, count, false);
    command_ = on_grid(command, 0.0, kGrid_s, count, false);
  }

  // Start and end of the stance: settled after the landing, until the force vanishes or the controller
  // changes to flight.
  static std::pair<double, double> stance(const Trial& trial, const Samples& phase, const Samples& force) {
    std::size_t first = 0;
    while (first < phase.value.size() && phase.value[first] == 0.0) ++first;
    std::size_t last = first;
    while (last + 1 < phase.value.size() && phase.value[last + 1] != 0.0) ++last;
    if (first >= phase.value.size()) return {1.0, 0.0};
    double to_s = phase.time_s[last];
    // A force plate may have an offset; its readings in flight show it.
    std::vector<double> in_flight;
    for (std::size_t i = 0; i < force.value.size(); ++i)
      if (force.time_s[i] > to_s + kFlightBegins_s) in_flight.push_back(force.value[i]);
    double zero_N = 0.0;
    if (in_flight.size() > 5) {
      const auto middle = in_flight.begin() + static_cast<std::ptrdiff_t>(in_flight.size() / 2);
      std::nth_element(in_flight.begin(), middle, in_flight.end());
      zero_N = *middle;
    }
    // The controller may change to stance before the foot has landed.
    double landed_s = phase.time_s[first];
    for (std::size_t i = 0; i < force.value.size() && force.time_s[i] < to_s; ++i) {
      if (force.time_s[i] < landed_s) continue;
      landed_s = force.time_s[i];
      if (force.value[i] > zero_N + 2.0 * kInTheAir_N) break;
    }
    const double from_s = landed_s + trial.setup_or("contact_settling_s", kSettling_s);
    for (std::size_t i = 0; i < force.value.size(); ++i)
      if (force.time_s[i] > from_s && force.time_s[i] < to_s && force.value[i] < zero_N + kInTheAir_N)
        to_s = force.time_s[i] - 2.0 * kRow_s;
    return {from_s, to_s};
  }

  Signal acting_torque(const Edits& edits) const {
    Signal used = command_;
    Signal acting = command_;
    std::vector<double> times(command_.values.size());
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = kGrid_s * static_cast<double>(i);
    observe(used, {}, edits, "actuator", times, acting.values);
    return acting;
  }

  static double offset_of_encoder(const Edits& edits) {
    double offset = 0.0;
    for (const auto& edit : edits.sensors)
      if (edit.channel == "motor_left_position_rad" && edit.kind == SensorEdit::Kind::offset)
        offset += edit.value;
    return offset;
  }

  void label_rows() {
    Coordinate phi{"motor_position_rad", {}}, rate{"motor_velocity_radps", {}}, time{"t_s", {}};
    for (const Row& row : rows) {
      phi.values.push_back(angle_.at(row.time_s));
      rate.values.push_back(rate_.at(row.time_s));
      time.values.push_back(row.time_s);
    }
    coordinates = {std::move(phi), std::move(rate), std::move(time)};
  }

  Belief belief_;
  Signal angle_, rate_, acceleration_, command_;
  std::vector<double> times_;
};

}  // namespace

bool is_standing_leg(const WorldConfig& world) {
  const auto& leg = world.robot.leg;
  return world.terrain.rigid && leg.foot_mass_kg + leg.upper_link_mass_kg + leg.lower_link_mass_kg < 1e-6;
}

std::unique_ptr<TrialModel> standing_leg(const Trial& trial, const Belief& belief, std::uint32_t channel,
                                         std::string& why) {
  auto model = std::make_unique<StandingLeg>(trial, belief, channel);
  if (model->rows.size() >= 20) return model;
  why =
      "a leg without mass on rigid ground needs motor position, command, phase and load_cell_force_N in "
      "stance";
  return nullptr;
}

}  // namespace sandhopper::diagnose
