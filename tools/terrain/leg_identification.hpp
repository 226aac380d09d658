#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "estimation/joint_force.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/terrain/leg_hop.hpp"

// Parameters for the leg's own force estimate, identified against a force plate on some hops and tested on
// others. Model (estimation/joint_force.hpp) for a foot at rest, with the believed links:
//   F_c(t + d) = weight + [s tau - J phidd - c tanh(phid/0.2) - b phid]/L' + link terms
// with s the scale of the commanded torque, J the rotors' inertia reflected to the joint, c and b the joint's
// friction, and d the delay of the plate's clock behind the motors' clock. It is linear in s, J, c and b; d
// is found by search. A spring beside the motor, + p - k phi, is added if it reduces the leave-one-hop-out
// error.
namespace sandhopper {

enum class LegParameter : std::uint8_t { torque_scale, rotor_inertia, coulomb, viscous, clock_offset };
inline constexpr std::size_t kLegParameters = 5;
using LegParameterValues = std::array<double, kLegParameters>;  // in this order; N m, kg m^2, N m s, s

struct LegIdentificationOptions {
  std::vector<double> half_widths_s{0.008, 0.010, 0.012, 0.014, 0.016, 0.018, 0.020, 0.024};
  std::vector<double> observer_gains_per_s{40.0, 60.0, 80.0, 100.0, 130.0, 170.0, 220.0, 300.0, 400.0};
  double reference_window_s = 0.001;  // the plate is averaged over +- this time around each motor row
  double contact_force_N = 10.0;      // force above the tare at which the foot counts as landed
  double friction_switch_radps = 0.2;
  double spring_gain = 0.05;  // share by which a spring must reduce the leave-one-hop-out error
  std::size_t bootstrap = 1000;
  unsigned seed = 1;
};

// Methods of force estimation, in the order in which they are reported.
enum class LegForceForm : std::uint8_t {
  quasi_static,        // tau / L' of the commanded torque
  joint_row_smooth,    // the identified model with derivatives over +- half width: offline
  joint_row_observer,  // the identified model as momentum observer: causal, at the motor's own rate
  reduced_row          // M_f g + beta tau + C phid^2 with the same parameters and the body's mass: causal
};
inline constexpr std::size_t kLegForceForms = 4;

// Part of a hop in which the error is evaluated.
enum class LegWindow : std::uint8_t {
  settled,    // contact, from contact_settling_s after the landing to the controller's liftoff
  contact,    // contact, from the landing on
  controller  // all of the controller's stance, including the air before the landing
};
inline constexpr std::size_t kLegWindows = 3;

struct LegHopFit {
  std::string trial;
  bool held_out = false;
  double landing_s = 0.0;  // from the hop's first row; zero if it starts in contact
  std::array<std::array<double, kLegWindows>, kLegForceForms> rms_N{};
  // Error of the observer against the plate's force after the same lag, in settled stance: its noise and
  // model error without its delay.
  double observer_without_delay_N = 0.0;
  // For figures: rows of stance.
  std::vector<double> t_s;  // from the file's first row
  std::vector<double> reference_N;
  std::array<std::vector<double>, kLegForceForms> force_N;
  std::vector<double> rate_radps;
  std::vector<bool> settled;
};

struct LegIdentification {
  LegParameterValues value{};
  std::array<PercentileInterval, kLegParameters> interval{};  // bootstrap over hops
  double tare_N = 0.0;                                        // reading of the plate in flight
  double believed_mass_kg = 0.0;
  TrialMean mass_kg{};        // impulse over the cycle / (g T), for hops with a landing
  double half_width_s = 0.0;  // chosen by leave-one-hop-out
  double observer_gain_per_s = 0.0;
  std::vector<std::pair<double, double>> cross_validation_N;  // half width, rms
  std::vector<std::pair<double, double>> settling_rms_N;      // time after landing, and held-out rms offline
  std::size_t fit_hops = 0, held_out_hops = 0;
  bool has_spring = false;
  double spring_torque_Nm = 0.0, spring_stiffness_Nm_per_rad = 0.0;  // p and k
  PercentileInterval spring_stiffness_interval{};
  double with_spring_N = 0.0;  // leave-one-hop-out error with the spring, at the chosen half width
  double foot_mass_kg = 0.0;   // value of a free foot mass in the fit; not used, because torque scale and
                               // friction can replace it
  PercentileInterval foot_mass_interval{};
  std::vector<LegHopFit> hops;

  double observer_without_delay_N(bool held_out) const;
  // Root of the mean over hops of the mean squared error.
  double rms_N(LegForceForm form, LegWindow window, bool held_out) const;
};

// Only hops that are not held out are used for identification; the others are used only for the errors.
// Throws std::invalid_argument for fewer than two hops to fit.
LegIdentification identify_leg(std::span<const LegHop> hops, const LegIdentificationOptions& options);

}  // namespace sandhopper
