#pragma once
#include <vector>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// Balances of rail and joint of one recorded hop. With specific forces s_b, s_f of body and foot, the leg's
// length L(phi), the mass matrix M(phi) of (foot, phi), and the ground's force F_c:
//   phidd = (s_b - s_f - L'' phid^2) / L'
//   F_rail = M11 s_f + M12 phidd + M12' phid^2 - F_c
//   tau_joint = M22 phidd + M12 s_f + M22'/2 phid^2 - tau_motor - L' F_rail
// minus the believed friction and cogging. Empty without both accelerometers and an encoder. Without a load
// cell they cover only flights; without currents only the rail.
std::vector<Balance> balances_of(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
