#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/discrepancy/open_world.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// Decides if the residual of the listed effects is unknown physics.
namespace sandhopper::diagnose {

// Law of free form found in the force balances of the recordings. It does not depend on any fit, so it is
// computed once, on first use.
class BalanceLaw {
 public:
  BalanceLaw(const Problem& problem, const Recordings& recordings)
      : problem_(&problem), recordings_(&recordings) {}
  const std::optional<FreeGain>& operator()();

 private:
  const Problem* problem_;
  const Recordings* recordings_;
  bool asked_ = false;
  std::optional<FreeGain> law_;
};

// Result of `unexplained_by`.
struct Unexplained {
  Misfit misfit;
  std::optional<FreeGain> law;  // Explains most of the residual on held-out trials.
  double share = 0.0;           // Fraction of the explainable deviance that the law explains.
  double left = 0.0;            // residual RMS / noise RMS
  CommonShift shift;
  bool shift_is_unknown = false;
  std::optional<NoisyChannel> noisy;
  bool unknown = false;     // Unlisted physics is present.
  double gap_closed = 1.0;  // By named effects: explained / (explained + left), deviances.

  double remainder() const { return law ? law->held_out : 0.0; }
};

// Misfit of the best set.
Misfit misfit_of(const Problem& problem, const Search& search);

// `faults`: the recordings hold faulty samples. Then a residual above the noise is not taken as unknown
// physics.
Unexplained unexplained_by(Problem& problem, const Search& search, const Belief& belief, bool faults,
                           BalanceLaw& balance, std::vector<std::string>& log);

}  // namespace sandhopper::diagnose
