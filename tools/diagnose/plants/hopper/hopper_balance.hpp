#pragma once
#include <vector>

#include "tools/diagnose/model/plant.hpp"

namespace sandhopper::diagnose {

// Rail and joint of one recorded hop. With specific forces s_b, s_f of body and foot, L(phi) the leg's
// length, M(phi) the mass matrix of (foot, phi), F_c the ground's force:
//   phidd = (s_b - s_f - L'' phid^2) / L'
//   F_rail = M11 s_f + M12 phidd + M12' phid^2 - F_c
//   tau_joint = M22 phidd + M12 s_f + M22'/2 phid^2 - tau_motor - L' F_rail
// less the friction and cogging that are believed. Empty without both accelerometers and an encoder; without
// a load cell only flights are told; without currents only the rail.
std::vector<Balance> balances_of(const Trial& trial, const Belief& belief);

}  // namespace sandhopper::diagnose
