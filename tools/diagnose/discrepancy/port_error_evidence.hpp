#pragma once
#include <functional>
#include <span>
#include <vector>

#include "tools/diagnose/fit/prepare.hpp"

namespace sandhopper::diagnose {

// Log evidence of recordings in which nothing is missing, for each size s of the port error
// (PlantModel::port_error):
//   ln Z(s) = sum_t -1/2 ln|I + M_t M_t'| - 1/2 y_t' (I + M_t M_t')^-1 y_t,   M_t = [Z_t S^1/2, D_t(s)]
// y_t: residual of trial t with its nuisances at 0, Z_t: derivatives by its nuisances (and those of its
// stretches), S: their prior variances, D_t: columns of the model error; all whitened by the noise, which is
// estimated anew for each size (its determinant is part of ln Z). Stuck and lost samples are left out. The
// tolerances stay where they were fitted. Sizes that several programs prefer are what PlantModel::port_error
// should be. `progress` is called with the share of the work done.
std::vector<double> port_error_evidence(
    const Recordings& recordings, std::span<const double> sizes,
    const std::function<void(double)>& progress = [](double) {});

}  // namespace sandhopper::diagnose
