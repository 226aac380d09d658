#pragma once
#include <Eigen/Dense>

#include "tools/terrain/leg_identification.hpp"

// Linear part of the leg's identification.
namespace sandhopper {

// A hop on the grid of its motor rows, with derivatives.
struct PreparedHop {
  const LegHop* hop = nullptr;
  double landing_s = 0.0;
  std::vector<JointState> state;
  std::vector<bool> settled;
  std::vector<double> reference_integral_Ns;  // of the plate minus its tare, at the plate's own times
};

double plate_tare_N(std::span<const LegHop> hops);  // median in the second half of flight, over the fit hops
PreparedHop prepare_hop(const LegHop& hop, double half_width_s, double tare_N,
                        const LegIdentificationOptions& options);
// Mean of the plate minus its tare over +- window around t.
double reference_at_N(const PreparedHop& prepared, double t_s, double window_s);
bool in_settled_stance(const PreparedHop& prepared, std::size_t row, double settling_s);

// Linear parameters: s, J, c, b, the foot's mass, torque at angle zero and stiffness of a spring beside the
// motor.
inline constexpr int kLinear = 7;
enum class LinearModel { friction, friction_and_foot, friction_and_spring };
using NormalMatrix = Eigen::Matrix<double, kLinear, kLinear>;
using LinearValues = Eigen::Matrix<double, kLinear, 1>;

// Normal equations of one hop for each clock offset on a grid; every hop has the weight one.
struct HopEquations {
  NormalMatrix normal = NormalMatrix::Zero();
  std::vector<LinearValues> right;  // one per offset
  std::vector<double> squares;
};
std::vector<double> clock_offsets_s();  // grid: +-5 ms in steps of 0.25 ms
HopEquations equations_of(const PreparedHop& prepared, const LegIdentificationOptions& options);

// Least squares of several hops at the best offset. Terms that the model lacks are zero.
struct LinearFit {
  LinearValues value = LinearValues::Zero();
  double clock_offset_s = 0.0;
};
LinearFit solve(std::span<const HopEquations* const> hops, LinearModel model);

// Mean square error [N^2] of a fit on a hop.
double mean_square(const HopEquations& hop, const LinearFit& fit);

// Regressors of one row, and the part of the force that the belief already explains.
LinearValues regressors(const Leg& leg, const JointState& state, double torque_Nm, double switch_radps);
Leg bare_leg(const LegParameters& believed);  // without rotors; with a dummy body mass if there is none

}  // namespace sandhopper
