#pragma once
#include <Eigen/Core>
#include <map>
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Derivatives of every row at one point by everything that may be missing: each amplitude of each candidate,
// and each knot of the laws of free form. They are computed once for the noise model, the screen, the
// repeatable model error and unknown laws.
struct Signatures {
  // One candidate with one choice of its shapes (`shape_choices`).
  struct Alternative {
    std::size_t candidate = 0;
    std::vector<double> values;           // all parameters; an amplitude is 0 or a listed size
    std::vector<std::size_t> amplitudes;  // indices of parameters, one column each
    std::vector<double> steps;            // step of the derivative, in typical sizes
    Eigen::Index first = 0;               // index of its first column
  };
  struct LawOfFreeForm {
    FreeFamily family;
    Eigen::Index first = 0;
  };
  std::vector<Alternative> alternatives;
  std::vector<LawOfFreeForm> laws;
  // Per trial: derivatives in the rows' units, per typical size of an amplitude or per scale of a port.
  std::vector<Eigen::MatrixXd> columns;
};

struct SignatureOptions {
  bool laws = true;  // include laws of free form
  // Only these candidates, by index, with secants in place of derivatives: the size of the first amplitude,
  // in typical sizes, to which its column refers.
  const std::map<std::size_t, double>* sizes = nullptr;
  const std::vector<KeptColumns>* columns = nullptr;  // as in LineariseOptions
};
Signatures signatures_at(const Problem& problem, const Point& point, const SignatureOptions& options = {});

}  // namespace sandhopper::diagnose
