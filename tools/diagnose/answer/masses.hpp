#pragma once
#include <vector>

#include "tools/diagnose/answer/diagnosis.hpp"

// Limits of the masses of an answer's effects; they only lower masses.
namespace sandhopper::diagnose {

// Sorts by explained deviance and limits the masses of the effects after the first: a small one may only
// correct the form of the first one's law. A small sensor fault puts the first law in doubt, too.
void limit_beside_each_other(std::vector<FoundEffect>& effects);

// The rest that the named effects leave.
struct BesideNames {
  double gap_closed = 1.0;   // by the names
  bool unknown = false;      // something unlisted is present
  bool has_law = false;      // a law of free form explains part of the rest
  bool not_checked = false;  // too few trials, or a limit of time
};

// Limits the masses by the rest. True if the names carry the verdict: they close more than half of the gap,
// and one of them is more likely than not.
bool limit_by_rest(std::vector<FoundEffect>& effects, const BesideNames& rest);

// Mass of an unknown effect by the p-value of its law: 1/2 from kSignificance on.
double mass_of_unknown(double p_value);

}  // namespace sandhopper::diagnose
