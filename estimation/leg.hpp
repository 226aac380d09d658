#pragma once
#include "config/fields.hpp"

// Kinematics and rigid-body dynamics of the symmetric five-bar leg on a vertical rail, generalised
// coordinates q = [x_f, phi]: height of the foot's sole and angle of the upper links from straight down. Both
// sides move as mirror images. The controller, the observer, the simulator and the diagnosis all use these
// functions.
//
// Equation of motion (rows x_f, phi), F_c the ground's force on the foot, tau the sum of the motors' torques
// on the upper links, (Q1, Q2) other generalised forces:
//   M11 xdd + M12 phidd + M12' phid^2     + M11 g = F_c + Q1
//   M12 xdd + M22 phidd + M22' phid^2 / 2 + M12 g = tau + Q2
// Eliminating phidd:  M_f (xdd + g) = F_c + Q1 - beta (tau + Q2) - C phid^2.
namespace sandhopper {

inline constexpr double kGravity_mps2 = 9.81;

// Geometry and inertia. Link values are per link, rotor values per motor (motor side). The default is the
// robot with the 80 mm foot. With motor_count = 1 one motor drives both sides.
struct LegParameters {
  double body_mass_kg = 1.60;
  double foot_mass_kg = 0.55;
  double upper_link_mass_kg = 0.05;
  double lower_link_mass_kg = 0.04;
  double upper_link_length_m = 0.12;
  double lower_link_length_m = 0.24;
  double upper_link_com_m = 0.06;            // from the hip axis
  double lower_link_com_m = 0.12;            // from the knee
  double upper_link_inertia_kg_m2 = 6.0e-5;  // about the link's centre of mass
  double lower_link_inertia_kg_m2 = 1.92e-4;
  double rotor_inertia_kg_m2 = 2.0e-4;
  double gear_ratio = 1.0;  // motor turns per link turn
  int motor_count = 2;
  double hip_offset_m = 0.0;    // half the distance between the hip axes
  double foot_height_m = 0.12;  // sole to toe joint
  double foot_radius_m = 0.040;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("body_mass_kg", self.body_mass_kg, Range{0.0, 50.0});
    visit("foot_mass_kg", self.foot_mass_kg, Range{0.0, 20.0});
    visit("upper_link_mass_kg", self.upper_link_mass_kg, Range{0.0, 10.0});
    visit("lower_link_mass_kg", self.lower_link_mass_kg, Range{0.0, 10.0});
    visit("upper_link_length_m", self.upper_link_length_m, Range{0.01, 1.0});
    visit("lower_link_length_m", self.lower_link_length_m, Range{0.01, 1.0});
    visit("upper_link_com_m", self.upper_link_com_m, Range{-1.0, 1.0});
    visit("lower_link_com_m", self.lower_link_com_m, Range{-1.0, 1.0});
    visit("upper_link_inertia_kg_m2", self.upper_link_inertia_kg_m2, Range{0.0, 1.0});
    visit("lower_link_inertia_kg_m2", self.lower_link_inertia_kg_m2, Range{0.0, 1.0});
    visit("rotor_inertia_kg_m2", self.rotor_inertia_kg_m2, Range{0.0, 0.1});
    visit("gear_ratio", self.gear_ratio, Range{0.1, 200.0});
    visit("motor_count", self.motor_count, Range{1, 2});
    visit("hip_offset_m", self.hip_offset_m, Range{0.0, 0.5});
    visit("foot_height_m", self.foot_height_m, Range{0.0, 1.0});
    visit("foot_radius_m", self.foot_radius_m, Range{0.001, 1.0});
  }
};

// Hip-to-toe length and its derivatives with respect to phi [m, m/rad, m/rad^2].
struct LegKinematics {
  double length_m;
  double dlength_m_per_rad;    // L', negative: the leg shortens as phi grows
  double d2length_m_per_rad2;  // L''
};

// Mass matrix, its derivatives with respect to phi, and the reduced quantities of the foot's equation.
struct LegDynamics {
  LegKinematics leg;
  double m11_kg;
  double m12_kg_m;
  double m22_kg_m2;
  double dm12_kg_m_per_rad;
  double dm22_kg_m2_per_rad;
  double reduced_mass_kg;           // M_f = M11 - M12^2/M22
  double torque_gain_per_m;         // beta = M12/M22
  double coriolis_N_s2_per_rad2;    // C = M12' - beta M22'/2
  double dreduced_mass_kg_per_rad;  // M_f' = -2 beta M12' + beta^2 M22'
};

class Leg {
 public:
  // Throws std::invalid_argument if the lengths do not form a leg (the lower link must be longer than upper
  // link plus hip offset) or if the mass matrix would be singular.
  explicit Leg(const LegParameters& parameters);

  LegKinematics kinematics(double angle_rad) const noexcept;
  LegDynamics dynamics(double angle_rad) const noexcept;

  // Angle in (0, pi) at which the leg has this length; found by Newton's method, clamped to the reachable
  // range.
  double angle_at_length(double length_m) const noexcept;

  double total_mass_kg() const noexcept { return total_mass_kg_; }
  const LegParameters& parameters() const noexcept { return p_; }

 private:
  LegParameters p_;
  double lower_com_to_toe_m_;  // e2 = l2 - c2
  double total_mass_kg_;
  double rotor_inertia_total_kg_m2_;  // motor_count * Jr * N^2, on the link side
};

// Kinetic plus gravitational energy of the moving parts [J]. Height is zero at x_f = 0; the foot's mass
// counts at the height of its sole.
double mechanical_energy_J(const Leg& leg, double foot_z_m, double foot_velocity_mps, double angle_rad,
                           double angular_velocity_radps) noexcept;

}  // namespace sandhopper
