#pragma once
#include <span>

// Elasticity in series with the ground, from a force-displacement record: the rig pressed on a rigid stop, or
// the foot during unloading.
namespace sandhopper {

struct ForcePath {
  std::span<const double> displacement_m;  // increases as the rig advances
  std::span<const double> force_N;         // compression positive; one value per displacement
};

struct LoadingCompliance {
  double compliance_m_per_N = 0.0;  // slope of displacement over force, for forces of at least a quarter of
                                    // the largest
  double toe_m = 0.0;               // displacement beyond first contact at which that line reaches zero
                                    // force: play, dust
  double rms_m = 0.0;               // rms residual of that line
  double greatest_force_N = 0.0;
};

// Least squares of displacement over force from first contact (force above contact_force_N from then on) to
// the largest force. NaN if fewer than five samples carry load.
LoadingCompliance loading_compliance(const ForcePath& path, double contact_force_N);

struct Unloading {
  double stiffness_N_per_m = 0.0;  // secant from the largest force to the lowest force after it
  double force_drop_N = 0.0;
  double recovery_m = 0.0;  // displacement recovered
};

// NaN if less than half of the largest force was removed. A recovery below resolution_m is replaced by
// resolution_m; the stiffness is then a lower bound.
Unloading unloading(const ForcePath& path, double resolution_m);

}  // namespace sandhopper
