#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// How the simulation changes with a little of everything that may be missing at one point: the derivative of
// every row by each amplitude of each candidate, and by each knot of the laws of free form. Made once there,
// for the noise model, the screen, repeatable model error and unknown laws.
struct Signatures {
  // One candidate with one choice of its shapes (`shape_choices`).
  struct Alternative {
    std::size_t candidate = 0;
    std::vector<double> values;           // shapes; amplitudes are zero
    std::vector<std::size_t> amplitudes;  // parameters, one column each
    std::vector<double> steps;            // in typical sizes, over which the derivative was taken
    Eigen::Index first = 0;               // column
  };
  struct LawOfFreeForm {
    FreeFamily family;
    Eigen::Index first = 0;
  };
  std::vector<Alternative> alternatives;
  std::vector<LawOfFreeForm> laws;
  // Of every trial: rows in their units, per typical size of an amplitude or scale of a port.
  std::vector<Eigen::MatrixXd> columns;
};

struct SignatureOptions {
  bool laws = true;  // of free form, too
};
Signatures signatures_at(const Problem& problem, const Point& point, const SignatureOptions& options = {});

}  // namespace sandhopper::diagnose
