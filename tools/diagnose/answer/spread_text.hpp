#pragma once
#include <string>

#include "tools/diagnose/answer/diagnosis.hpp"

// Sentences on the nuisances that a fit moved beyond their believed spread.
namespace sandhopper::diagnose {

// "-20 %" or "0.0012 m"
std::string amount_in_words(const TrialToTrial& nuisance, double value);
// "stiffness_per_area"
std::string subject_of(const TrialToTrial& nuisance);
// "stiffness_per_area differs by -20 % in Versuch_05, 5.2 times the stated 3.8 %, ..."; empty: the values
// beside what was found lie within the believed spreads, and none that nobody stated has a mean other than
// zero.
std::string beyond_spread(const Diagnosis& diagnosis);
// The consequence of that, as a sentence.
std::string otherwise(const Diagnosis& diagnosis);
// Nuisances that exceeded their spread before the effects were put in, and that the effects brought nearer to
// zero; empty: none.
std::string taken_up_before(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
