#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/answer/verdict.hpp"
#include "tools/diagnose/evidence/simple_answers.hpp"

namespace sandhopper::diagnose {

// Contents of diagnosis.json; see tools/diagnose/README.md.
struct FoundParameter {
  std::string name;
  double value = 0.0;
  double low = 0.0, high = 0.0;  // 95 % interval
  bool derived = false;          // Says the same as another parameter in another way, or as a change.
  bool is_change = false;        // Change of the parameter before it against the belief.
  // Limit of its range at which the estimate lies. Empty: it lies within, or nothing lies beyond the limit.
  std::optional<double> limit{};

  std::string limit_in_words() const;  // "at its limit of 60 Hz: the true value may lie beyond"; or empty
};

// One effect of the answer: listed, unknown ("unknown@PORT"), or a fault of the data.
struct FoundEffect {
  std::string id;
  std::string port;
  std::string channel{};
  std::string statement;
  std::string equation;
  std::vector<FoundParameter> parameters;
  double probability = 0.0;  // the calibrated `mass`
  // Posterior mass of the sets that hold this name or one of its class; 1: not from a posterior.
  double posterior_mass = 1.0;
  double mass = 1.0;  // the same, lowered where a rule of the answer limits it
  // Fraction of the explained deviance that held-out trials lose without this effect.
  double heldout_gain = 0.0;
  double p_value = 1.0;
  // |first amplitude| in typical sizes.
  double typicals = 0.0;
  std::vector<std::string> indistinguishable_from{};

  bool is_unknown() const { return id.starts_with("unknown@"); }  // not a listed effect
  // True if the 95 % interval of the first parameter contains zero (or that of its change against the belief,
  // which follows it). Such an effect is suspected, not found.
  bool may_be_zero() const;
};

// A channel and phase (or third of a trial) in which the recordings show what was found.
struct Where {
  std::string channel;
  std::string port;  // Port of the found effect that changes this cell most; empty if none does.
  std::string phase;
  double from_s = 0.0, to_s = 0.0;
  std::vector<std::string> trials;
  // Quantity along which the change varies most, and the range of its larger values.
  std::string coordinate;
  double range_low = 0.0, range_high = 0.0;
  // Part of the squared change over the noise, over all channels and phases. Unexplained: part of the excess
  // of the squared error.
  double share_of_excess = 0.0;
  bool unexplained = false;  // True if nothing was found: error of the simulation as believed.
  double p_value = 1.0;

  std::string share_in_words() const;
  std::string phase_in_words() const;  // "flight down", "the first third"
};

// RMS errors of the null and of the answer, in the channel's unit.
struct ErrorBeforeAfter {
  double before = 0.0, after = 0.0;
};

// Standard deviation of one sample of a channel, in the channel's unit.
struct SensorNoise {
  std::string channel;
  double stated = 0.0;     // by the belief; 0: not stated
  std::string source{};    // source of the stated value: a file and line, or a default
  double measured = 0.0;   // from the fast fluctuation, from sample to sample
  double used = 0.0;       // by the fit: what the residuals show beside what was found, without model error
  bool is_raised = false;  // `used` is more than the sensor's own noise
  bool is_sensor_worse = false;  // raised, and `measured` alone exceeds `stated`

  double own() const { return stated > 0.0 ? stated : measured; }
  double times() const { return used / own(); }
  std::string in_words() const;  // the sizes, the factor, and what it means for the answer
};

// "5.3 times the noise floor before, 0.7 after"
std::string times_the_floor(const ErrorBeforeAfter& error, double floor);
// "0.97 times the noise floor".
std::string times_the_floor(double error, double floor);

// Answer of the run that wrote the model in use.
struct FirstAnswer {
  std::string file;                     // "answer/diagnosis.json"
  std::map<std::string, double> error;  // per channel: held-out error before, beyond the noise floor
};

// Rest of a channel's error above its noise floor, RMS: sqrt(error^2 - floor^2), or 0.
double beyond_floor(double error, double floor);

// Errors of one channel on all trials, fitted (train) and held out.
struct ChannelFit {
  std::string channel;
  ErrorBeforeAfter train, heldout;
  double floor = 0.0;  // Noise, model error and the uncertainty of recorded inputs, over the rows.
  double noise = 0.0;  // Noise alone: standard deviation of one sample.
  double range = 0.0;  // of the recorded values, over all trials
};

// RMS errors on held-out trials in one phase, and the noise floor of that phase, in the channel's unit.
struct PhaseError {
  std::string channel;
  std::string phase;
  double before = 0.0, after = 0.0, floor = 0.0;
  std::size_t samples = 0;
};

// One channel of one trial, recorded and simulated, in the channel's unit; thinned for the page.
struct Trace {
  std::string trial;
  std::string setup;  // as text
  std::string channel;
  std::vector<double> time_s, measured, before, after;  // after: held out
  std::vector<double> floor;  // Standard deviation of each row if nothing is missing.
};

// One compared row: recorded minus simulated, in the channel's unit.
struct ResidualRow {
  std::string trial, channel, phase;
  double time_s = 0.0, before = 0.0;
  double after = 0.0;  // held out
  double noise_sd = 0.0;
};

struct Bound {  // Upper bound of an effect that was not found; all of an answer hold together with 95 %.
  std::string id;
  std::string parameter;
  double value = 0.0;     // of its magnitude
  double typicals = 0.0;  // the same, in typical sizes
  // True: `value` is a lower bound. An effect whose parameter is a stiffness or a limit grows as that falls.
  bool is_lower = false;
};

// One number of the belief that the answer depends on.
struct BelievedNumber {
  std::string key;               // "axis.inertia_kg_m2"
  double low = 0.0, high = 0.0;  // Smallest and largest value over the trials.
  std::string unit{};
  // Source: a file and line, a set-up, or a default with its reason.
  std::string source{};
  // Error to be expected from how the number is written: half a unit of its last digit. For a default that
  // nobody stated: its full size.
  double usual_error = 0.0;
  // Error beyond which the recordings contradict the number (95 %), with the nuisances refitted. Infinite:
  // the recordings do not depend on it.
  double error_that_shows = 0.0;
  // If [known_to] states how well the number is known: its standard deviation, and the change that these
  // recordings ask for, the same in all trials.
  double known_sd = 0.0, asked_for = 0.0;

  double size() const { return low < 0.0 && -low > high ? -low : high; }
  bool matters() const { return usual_error >= error_that_shows; }
};

// A law of free form: value and standard deviation at the knots `at` of the variable.
struct Curve {
  std::string variable;
  std::vector<double> at, value, sd;
};

// An unlisted force or torque that was found at a port.
struct UnknownForce {
  std::string port;
  std::string quantity;  // acting quantity with its unit, for example force_N
  double p_value = 1.0;
  double share = 0.0;  // fraction of the explainable deviance
  Curve curve;
};

// The recommended trial, or the bench test if no trial that can be simulated splits a class.
struct NextTrial {
  // "split" a class, "sharpen" intervals, "map" an unknown force, "bound" absent effects, "repeat" after a
  // repair. Empty: no trial is recommended.
  std::string purpose;
  std::string why;    // Begins with `order`, if a trial is recommended.
  std::string order;  // An imperative: "Drop the body from 1.9 m".
  std::string kind;   // Empty: the test is no recording (a weighing), or no trial is recommended.
  std::map<std::string, double> setup;
  std::map<std::string, std::string> words;  // Set-up keys whose values are words (profile).
  // The set-up lies outside of what was recorded, and the campaign does not state its limits.
  bool beyond_recorded = false;
  // Probability that one such trial separates all rivals from the found effect, and at least one of them. 0
  // if there are no rivals, or for a bench test, which is not simulated.
  double settles = 0.0, splits = 0.0;
  // Predictions by two explanations; empty if there is only one.
  std::string channel;
  std::string first, second;
  double noise = 0.0;  // standard deviation of one sample
  std::vector<double> time_s, by_first, by_second;

  bool is_recommended() const { return !purpose.empty(); }
  std::string reason() const;  // `why` without the order
};

// A nuisance parameter in one trial.
struct SpreadValue {
  std::string trial;
  double before = 0.0, after = 0.0;
  // The value is further from zero than the believed spread allows: 1 % two-sided, Bonferroni over the trials
  // and all nuisances with a believed spread.
  bool exceeds_before = false, exceeds_after = false;
};

// A nuisance parameter: mean and standard deviation over the trials, fitted without any effect and with the
// found ones, and the believed standard deviation.
struct TrialToTrial {
  std::string name;  // ends with its unit, or with _relative
  double believed_sd = 0.0;
  double mean_before = 0.0, sd_before = 0.0;
  double mean_after = 0.0, sd_after = 0.0;
  std::vector<SpreadValue> values{};  // of the trials that have it
  bool is_default = false;            // nobody stated the spread
  // Nobody stated the spread, and its mean over the trials is not zero (Student's t, 1 %, Bonferroni over
  // such spreads): it stands for something that all trials share. Never where `Nuisance::is_own`.
  bool shifts_alike = false;
  std::string goes_with{};  // "falls with plate_diameter_m"; empty: the values are in no such order

  bool exceeds_before() const;  // in any trial
  bool exceeds_after() const;
};

// The whole answer, as written to diagnosis.json, text and page.
struct Diagnosis {
  Verdict verdict = Verdict::insufficient_data;
  Detail detail = Detail::none;
  std::map<std::string, double> noise_floor;
  std::vector<Where> where;
  std::vector<FoundEffect> effects;
  double gap_closed = 1.0;       // By listed effects: fraction of the explainable deviance.
  std::vector<ChannelFit> fits;  // largest error over noise floor first
  std::vector<SensorNoise> noise;
  std::optional<FirstAnswer> first;  // if the model in use is a corrected one
  std::vector<Bound> absent;
  std::vector<BelievedNumber> belief;
  std::vector<UnknownForce> unknown;
  std::vector<std::string> notes;  // Missing channels, trials left out, tests with less power.
  std::vector<PhaseError> phase_errors;
  std::vector<TrialToTrial> trial_to_trial;
  std::vector<Trace> traces;
  std::vector<ResidualRow> residuals;
  NextTrial next;
  SimpleAnswers simple;
  std::string corrected_model_toml;
  std::string corrected_model_file{};  // name of the file that it was written to
  std::size_t trials = 0;
  std::uint64_t simulations = 0;
  double seconds = 0.0;
  std::vector<std::string> log;  // log of the search
  // The step in which a limit of time ended the search; empty if the search was complete. Bounds of absent
  // effects, the check for unlisted physics and the next trial are then missing.
  std::string stopped_in;
};

}  // namespace sandhopper::diagnose
