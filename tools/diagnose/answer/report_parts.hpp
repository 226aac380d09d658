#pragma once
#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/diagnose/discrepancy/left_over.hpp"
#include "tools/diagnose/discrepancy/open_world.hpp"
#include "tools/diagnose/evidence/posterior.hpp"
#include "tools/diagnose/evidence/search.hpp"
#include "tools/diagnose/fit/prepare.hpp"
#include "tools/diagnose/fit/residuals.hpp"
#include "tools/diagnose/model/parameter_names.hpp"
#include "tools/diagnose/recordings/data_faults.hpp"
#include "tools/diagnose/recordings/events.hpp"

// Parts of the answer. Each function adds one part to `diagnosis`, from the finished search.
namespace sandhopper::diagnose {

// Notes on trials left out, missing channels, and a small number of trials.
void note_what_is_missing(const Prepared& prepared, Diagnosis& diagnosis);
// Notes on stretches in which something happened once.
void report_events(const Problem& problem, const std::vector<Event>& events, Diagnosis& diagnosis);
// A believed law of another form leaves up to the plant's `form_error` of the explained deviance as a
// residual common to all trials. The expected part of it along any one parameter.
double form_deviance(const Problem& problem, double explained);
// The effects of the best set with parameters, intervals and probabilities.
void report_effects(const Problem& problem, const Search& search, const Posterior& belief,
                    Diagnosis& diagnosis);
// A law of free form as effect "unknown@PORT" and as curve.
void report_unknown(const FreeGain& gain, double share, Diagnosis& diagnosis);
// Adds an unknown effect without a law of free form, at the port of the effect that explains most.
// `gap_closed`: fraction of the gap that the effects close together. Call it after report_effects.
void report_unknown_near(double gap_closed, Diagnosis& diagnosis);
// For a diagnosis without effects: adds an unknown effect at the port of the noisy channel, or of the common
// nuisance offset.
void report_unknown_noise(const NoisyChannel& noisy, Diagnosis& diagnosis);
void report_unknown_shift(const CommonShift& shift, Diagnosis& diagnosis);
// For a plant with a single port: adds an unknown effect there, unless a sensor is noisy in a phase without
// forces.
void report_unknown_of_plant(const Problem& problem, Diagnosis& diagnosis);
// Effects that the recordings show without a fit. They also change the verdict if nothing else was found.
void report_broken_rules(const std::vector<BrokenRule>& rules, Diagnosis& diagnosis);
// Faults of the data (stuck, lost, clipped samples). They also change the verdict if nothing else was found.
void report_data_faults(const std::vector<DataFault>& faults, Diagnosis& diagnosis);
void report_errors(const Problem& problem, const Residuals& residuals, Diagnosis& diagnosis);
// Noise of each sensor: stated, measured, and as the fit uses it.
void report_noise(const Problem& problem, Diagnosis& diagnosis);
// Nuisance parameters before and after, over the trials and in each. `recorded`: the trials with their
// set-ups.
void report_trial_to_trial(const Problem& problem, const Search& search, const std::vector<Trial>& recorded,
                           Diagnosis& diagnosis);
void report_residuals(const Problem& problem, const Residuals& residuals, Diagnosis& diagnosis);
void report_traces(const Problem& problem, const Recordings& recordings, const Residuals& residuals,
                   Diagnosis& diagnosis);
// Bounds of the effects that were not found.
void report_absent(const Problem& problem, Search& search, Diagnosis& diagnosis);
// Sets `error_that_shows` of each number of `diagnosis.belief`.
void report_belief(const Problem& problem, const Point& answer, Diagnosis& diagnosis);
// Channels and phases in which the null's residual exceeds the noise floor.
void report_where(const Problem& problem, const Search& search, const Residuals& residuals,
                  Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
