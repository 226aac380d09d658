#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// If one law is named alone, names the most probable single law in its place, if the present one is less
// probable by more than Limits::exchangeable. The criterion of the search counts neither the form of a law
// nor how finely the parameters and nuisances of a set must be tuned: a weightless body whose trials each
// have their own speed fits a terminal speed better than a drag does. Only laws are compared, because the
// form error of an effect on readings is 0. Not for sets of several effects: there the form error of one law
// can stand for another effect. Repeatable model errors are left out for the same reason.
void name_likeliest(Problem& problem, Search& search, std::vector<std::string>& log);

// The law of free form with the largest posterior mass, beside the best set or beside nothing. None if no
// evidence can be computed.
struct LikelyLaw {
  FreeFamily family;
  bool beside_nothing = false;
};
std::optional<LikelyLaw> likeliest_law(Problem& problem, const Search& search);

// No effect is more probable than the posterior mass of the sets that hold it or one of its alternatives,
// among the complete fits that the criterion leaves in question (`Posterior::apart`). The weights of the
// criterion count neither the form of a law nor how finely a set must be tuned. Only lowers probabilities.
void limit_by_evidence(Problem& problem, const Search& search, Posterior& belief,
                       std::vector<std::string>& log);

// Appends to `log` the posterior mass of the sets with the smallest criterion, and of unknown laws added to
// the best set and to the null (one line each, most probable first).
void tell_evidence(Problem& problem, const Search& search, std::vector<std::string>& log);

}  // namespace sandhopper::diagnose
