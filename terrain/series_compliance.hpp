#pragma once
#include <span>

// What a force-displacement record says about elasticity in series with the ground: the rig pressed on a
// rigid stop, or the foot when it is relieved.
namespace sandhopper {

struct ForcePath {
  std::span<const double> displacement_m;  // growing as the rig is driven on
  std::span<const double> force_N;         // compression positive; one value per displacement
};

struct LoadingCompliance {
  double compliance_m_per_N = 0.0;  // slope of displacement over force where the force is at least a quarter
                                    // of its greatest
  double toe_m = 0.0;               // displacement at no force by that line, beyond first contact: play, dust
  double rms_m = 0.0;               // about that line
  double greatest_force_N = 0.0;
};

// Least squares of displacement over force from first contact (force above contact_force_N, for good) to the
// greatest force. NaN when fewer than five samples carry load.
LoadingCompliance loading_compliance(const ForcePath& path, double contact_force_N);

struct Unloading {
  double stiffness_N_per_m = 0.0;  // secant from the greatest force to the lowest that follows it
  double force_drop_N = 0.0;
  double recovery_m = 0.0;  // displacement given back
};

// NaN when less than half of the greatest force was taken off. A recovery below resolution_m is replaced by
// it: the stiffness is then a lower bound.
Unloading unloading(const ForcePath& path, double resolution_m);

}  // namespace sandhopper
