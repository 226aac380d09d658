#pragma once
#include "estimation/leg.hpp"
#include "terrain/bed.hpp"
#include "tools/plant/leg_table.hpp"
#include "tools/plant/world_config.hpp"

namespace sandhopper {

struct PlantState {
  double foot_z_m = 0.0;  // sole over the undisturbed surface
  double foot_velocity_mps = 0.0;
  double angle_rad = 0.0;  // upper link from straight down
  double angular_velocity_radps = 0.0;
  double series_m = 0.0;  // compression of the spring between toe and foot
  double series_mps = 0.0;
  double play_rad = 0.0;  // angle of the rotors minus that of the links
  double play_radps = 0.0;

  // The motors' encoders measure these.
  double rotor_rad() const noexcept { return angle_rad + play_rad; }
  double rotor_radps() const noexcept { return angular_velocity_radps + play_radps; }
};

// Quantities that follow from the state and the motors' torque at one instant.
struct PlantMotion {
  double foot_accel_mps2 = 0.0;
  double angular_accel_radps2 = 0.0;
  double body_z_m = 0.0;
  double body_velocity_mps = 0.0;
  double body_accel_mps2 = 0.0;
  double leg_length_m = 0.0;
  double contact_force_N = 0.0;
  double rail_force_N = 0.0;     // on the body, up positive; includes the cable
  double joint_torque_Nm = 0.0;  // friction, cogging and end stops on the upper links
};

// Forces in addition to the plant's own; see tools/diagnose.
class PlantExtension {
 public:
  virtual ~PlantExtension() = default;
  // Force on the body, upward positive; `leg_force_N` is the motors' torque expressed at the foot.
  virtual double rail_force_N(double body_z_m, double body_velocity_mps, double leg_force_N) const = 0;
  // Torque on the links, both sides together, positive in the direction of increasing angle.
  virtual double joint_torque_Nm(const PlantState& state, double motor_torque_Nm) const = 0;
};

// Body, foot, leg and bed, coupled, on a 0.1 ms grid (RK4):
//   M_f a_f = Q1 - beta (tau + Q2) - C phid^2 - M_f g + F_c
//   phidd from the second row of estimation/leg.hpp
//   Q1 = -rail_coulomb tanh(v_b / v_rail) - rail_viscous v_b - cable
//   Q2 = Q1 L' - n joint_coulomb tanh(phid / v_joint) + n cogging sin(periods phi) + end stops
// for n motors; v_rail, v_joint: rail_friction_switch_speed_mps, joint_friction_switch_speed_radps. With a
// series spring F_s = k s + c ds/dt between toe and foot (c = 2 zeta sqrt(k m_foot)), the first row holds for
// the toe without the foot's mass and with F_s instead of F_c. The foot has its own equation:
//   m_foot a_f = F_c - F_s - m_foot g
// With play in the joint the rotors (inertia J) move separately, and the links get the torque that the teeth
// transmit while they touch:
//   J rotor'' = tau - tau_t,  tau_t = K (|p| - play/2) sign(p) + D dp/dt,  K = 1 N m / (give play)
// F_c is the bed's force (terrain/bed.hpp), solved together with a_f. The deepest point increases after each
// step and is kept for later strides, which land in the crater. On rigid ground the foot stops at once
// (plastic impact) and stands until the force would become negative. Accurate to about 0.03 % of peak force
// at this step size.
class Plant {
 public:
  static constexpr double kStep_s = 1e-4;
  static constexpr double kEndStopLow_rad = 0.25;
  static constexpr double kEndStopHigh_rad = 2.6;

  struct Options {
    double cable_force_N = 0.0;  // constant, pulls the body down
    bool bed_memory = true;      // false: the surface is restored as soon as the foot is above
                                 // it
    // Factor on the speeds within which the believed dry friction of rail and joints changes its sign.
    double friction_switch_factor = 1.0;
    const PlantExtension* extension = nullptr;  // must outlive the plant
    const LegTable* leg_table = nullptr;        // of the same leg, used instead of it; must outlive the plant
  };

  // Throws std::invalid_argument if the leg is impossible.
  Plant(const WorldConfig& config, const Bed& bed, const Options& options);
  Plant(const WorldConfig& config, const Bed& bed) : Plant(config, bed, Options{}) {}

  // Sets the state. The foot's present depth becomes the deepest point; place_in_crater() gives a deeper one.
  void place(const PlantState& state) noexcept;
  void place_in_crater(const PlantState& state, double max_depth_m) noexcept;

  // One step with the motors' summed torque held through it.
  void step(double torque_Nm, double step_s = kStep_s) noexcept;

  PlantMotion motion(double torque_Nm) const noexcept;

  // Returns motion() and then makes a step by the midpoint rule: two evaluations instead of five in flight
  // and four in contact. The step is divided where the bed's force has a kink or a jump. It is meant for many
  // simulations of the same hop at 0.25 ms; the result depends smoothly on the initial values.
  PlantMotion advance(double torque_Nm, double step_s) noexcept;
  const PlantState& state() const noexcept { return state_; }
  const Leg& leg() const noexcept { return leg_; }
  const Bed& bed() const noexcept { return bed_; }
  double max_depth_m() const noexcept { return max_depth_m_; }
  // Integral of the contact force since place(). Its difference over an interval, divided by the interval's
  // length, is the mean force.
  double contact_impulse_Ns() const noexcept { return contact_impulse_Ns_; }

 private:
  struct Rates {
    LegDynamics dynamics;
    double foot_accel_mps2, angular_accel_radps2, contact_force_N, rail_force_N, joint_torque_Nm;
    double series_accel_mps2, play_accel_radps2;
  };
  static PlantState moved(const PlantState& from, const PlantState& at, const Rates& rates,
                          double dt_s) noexcept;
  double transmitted_Nm(const PlantState& state) const noexcept;
  void free_rotors(LegDynamics& dynamics) const noexcept;
  double longest_piece_s(const LegDynamics& dynamics, double step_s) const noexcept;
  Rates rates(const PlantState& state, double torque_Nm) const noexcept;
  double joint_torque_Nm(const PlantState& state) const noexcept;
  PlantMotion motion_of(const Rates& rates) const noexcept;
  // The bed's curve at the deepest point, stored while that point stays. Negative while the foot does not
  // unload.
  double deepest_N() const noexcept;
  double next_event_s(double accel_mps2) const noexcept;
  void midpoint(const Rates& at_start, double torque_Nm, double step_s) noexcept;
  void finish_step(double torque_Nm) noexcept;
  void settle_on_rigid_ground(double torque_Nm) noexcept;

  WorldRobotConfig robot_;
  double gravity_mps2_;
  Leg leg_;
  Bed bed_;
  Options options_;
  double motors_;
  bool rigid_;
  double series_N_per_m_ = 0.0, series_N_s_per_m_ = 0.0;  // 0: the toe is rigid
  double rotors_kg_m2_ = 0.0;                             // reflected to the links' side
  double teeth_Nm_per_rad_ = 0.0, teeth_Nm_s_ = 0.0;      // 0: no play

  PlantState state_{};
  double max_depth_m_ = 0.0;
  mutable double known_depth_m_ = 0.0, known_N_ = 0.0;  // a deepest point and the bed's curve there
  double contact_impulse_Ns_ = 0.0;
  bool standing_ = false;  // on rigid ground
};

}  // namespace sandhopper
