#pragma once
#include "tools/diagnose/data_faults.hpp"
#include "tools/diagnose/diagnosis.hpp"
#include "tools/diagnose/events.hpp"
#include "tools/diagnose/left_over.hpp"
#include "tools/diagnose/evidence/unknown_law.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/prepare.hpp"
#include "tools/diagnose/residuals.hpp"
#include "tools/diagnose/search.hpp"

// Parts of the answer, each made from the finished search.
namespace sandhopper::diagnose {

void note_what_is_missing(const Prepared& prepared, Diagnosis& diagnosis);
void report_events(const Problem& problem, const std::vector<Event>& events, Diagnosis& diagnosis);
void report_effects(const Problem& problem, const Search& search, const Posterior& belief,
                    Diagnosis& diagnosis);
// `probability` that something unknown acts at that port, `share` of all that can be explained.
void report_unknown(const UnknownLaw& law, double probability, double share, Diagnosis& diagnosis);
void report_broken_rules(const std::vector<BrokenRule>& rules, Diagnosis& diagnosis);
void report_data_faults(const std::vector<DataFault>& faults, Diagnosis& diagnosis);
void report_errors(const Problem& problem, const Residuals& residuals, Diagnosis& diagnosis);
void report_trial_to_trial(const Problem& problem, const Search& search, Diagnosis& diagnosis);
void report_residuals(const Problem& problem, const Residuals& residuals, Diagnosis& diagnosis);
void report_traces(const Problem& problem, const Recordings& recordings, const Residuals& residuals,
                   Diagnosis& diagnosis);
void report_absent(const Problem& problem, Search& search, Diagnosis& diagnosis);
void report_where(const Problem& problem, const Search& search, const Residuals& residuals,
                  Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
