#pragma once
#include <cmath>

// Momentum observer of the ground force on the foot (paper, force estimation; De Luca's residual for one
// reduced coordinate). With the leg's reduced quantities (estimation/leg.hpp)
//   p = M_f(phi) v_f,   pdot = psi + F_c,   psi = -beta tau - C phid^2 - M_f g + M_f' phid v_f
//   rdot = k (F_c - r)
// Discretised exactly for a momentum that changes linearly within the step:
//   r+ = e^{-kT} r + (1 - e^{-kT}) ((p+ - p)/T - psi).
namespace sandhopper {

class MomentumObserver {
 public:
  explicit MomentumObserver(double gain_per_s) noexcept : gain_per_s_(gain_per_s) {}

  // Starts at momentum p [kg m/s] with the force estimate r [N].
  void reset(double momentum_kg_mps, double force_N = 0.0) noexcept {
    momentum_kg_mps_ = momentum_kg_mps;
    force_N_ = force_N;
  }

  // Returns the force estimate r [N]. psi_N is the mean over the step that ended with this momentum.
  double update(double momentum_kg_mps, double psi_N, double dt_s) noexcept {
    const double keep = std::exp(-gain_per_s_ * dt_s);
    const double raw_force_N = (momentum_kg_mps - momentum_kg_mps_) / dt_s - psi_N;
    force_N_ = keep * force_N_ + (1.0 - keep) * raw_force_N;
    momentum_kg_mps_ = momentum_kg_mps;
    return force_N_;
  }

  double force_N() const noexcept { return force_N_; }

 private:
  double gain_per_s_;
  double momentum_kg_mps_ = 0.0;
  double force_N_ = 0.0;
};

}  // namespace sandhopper
