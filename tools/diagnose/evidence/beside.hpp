#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/discrepancy/free_laws.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"

namespace sandhopper::diagnose {

// If one law is named alone, names the most probable single law in its place (`bagged_masses`), if the
// present one is less probable by more than Limits::exchangeable. The criterion of the search counts neither
// the form of a law nor how finely the parameters and nuisances of a set must be tuned, nor whether the
// trials agree: a weightless body whose trials each have their own speed fits a terminal speed better than a
// drag does. Only laws are compared, because the form error of an effect on readings is 0. Not for sets of
// several effects: their masses would contradict the criterion, which counts differences less if the trials
// scatter. Repeatable model errors are left out, because they can stand for an effect.
void name_likeliest(Problem& problem, Search& search, std::vector<std::string>& log);

// The law of free form with the largest posterior mass, beside the best set or beside nothing. None if no
// evidence can be computed.
struct LikelyLaw {
  FreeFamily family;
  bool beside_nothing = false;
};
std::optional<LikelyLaw> likeliest_law(Problem& problem, const Search& search);

// No effect is more probable than the mass (`bagged_masses`) of the sets that hold it or one of its
// alternatives, among the complete fits that the criterion leaves in question (`Posterior::apart`). The
// weights of the criterion do not count what `bagged_masses` does. Only lowers probabilities.
void limit_by_evidence(Problem& problem, const Search& search, Posterior& belief,
                       std::vector<std::string>& log);

// Appends to `log` the masses over resampled trials of the sets with the smallest criterion, and the
// posterior masses of these sets and of unknown laws added to the best set and to the null (one line each).
void tell_evidence(Problem& problem, const Search& search, std::vector<std::string>& log);

}  // namespace sandhopper::diagnose
