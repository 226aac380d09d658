#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/discrepancy/misfit.hpp"
#include "tools/diagnose/discrepancy/open_world.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/fit/prepare.hpp"

// What the list of effects leaves, and whether that is physics of its own.
namespace sandhopper::diagnose {

// The law that the balances of the recordings show by themselves. No fit changes it: it is asked for once.
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

struct Unexplained {
  Misfit misfit;
  std::optional<FreeGain> law;  // of free form, that says most of it on trials it was not fitted to
  double share = 0.0;           // of all that can be explained, what that law has
  double left = 0.0;            // times the noise
  Lean lean;
  bool leans = false;
  std::optional<LoudChannel> loud;
  bool unknown = false;     // it is physics that is not on the list
  double gap_closed = 1.0;  // by the names: explained / (explained + left), deviances

  double remainder() const { return law ? law->held_out : 0.0; }
};

Misfit misfit_of(const Problem& problem, const Search& search);

// `faults`: something was recorded wrongly, and what is left beyond the noise may be that.
Unexplained unexplained_by(const Problem& problem, const Search& search, const Belief& belief, bool faults,
                           BalanceLaw& balance, std::vector<std::string>& log);

}  // namespace sandhopper::diagnose
