#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/diagnose/answer/verdict.hpp"
#include "tools/diagnose/evidence/simple_answers.hpp"

namespace sandhopper::diagnose {

// What diagnosis.json says; see tools/diagnose/README.md.
struct FoundParameter {
  std::string name;
  double value = 0.0;
  double low = 0.0, high = 0.0;  // 95 %
  bool derived = false;          // says the one before it again, as a change of what was believed
};

struct FoundEffect {
  std::string id;
  std::string port;
  std::string channel{};
  std::string statement;
  std::string equation;
  std::vector<FoundParameter> parameters;
  double probability = 0.0;
  double heldout_gain = 0.0;  // share of the held-out excess that goes with it
  double p_value = 1.0;
  double typicals = 0.0;
  std::vector<std::string> indistinguishable_from{};

  bool is_unknown() const { return id.starts_with("unknown@"); }  // on no list
  // The 95 % interval of its size, the first parameter (or its change against the belief, which follows it),
  // holds zero: suspected, not found.
  bool may_be_zero() const;
};

struct Where {
  std::string channel;
  std::string port;  // of what was found to act in this cell; empty where nothing found says
  std::string phase;
  double from_s = 0.0, to_s = 0.0;
  std::vector<std::string> trials;
  std::string coordinate;
  double range_low = 0.0, range_high = 0.0;
  double share_of_excess = 0.0;
  double p_value = 1.0;
};

struct ErrorBeforeAfter {
  double before = 0.0, after = 0.0;
};

// "5.3 times the noise floor before, 0.70 after".
std::string times_the_floor(const ErrorBeforeAfter& error, double floor);
// "0.97 times the noise floor".
std::string times_the_floor(double error, double floor);

struct ChannelFit {
  std::string channel;
  ErrorBeforeAfter train, heldout;
  double floor = 0.0;
};

// Held-out error in one phase; the floor is that phase's own.
struct PhaseError {
  std::string channel;
  std::string phase;
  double before = 0.0, after = 0.0, floor = 0.0;
  std::size_t samples = 0;
};

// One channel of one trial as recorded and as simulated, thinned to what a page draws.
struct Trace {
  std::string trial;
  std::string setup;  // in words
  std::string channel;
  std::vector<double> time_s, measured, before, after;  // after: held out
  std::vector<double> floor;  // standard deviation of each row when nothing is missing
};

// A row that was compared: recorded minus simulated.
struct ResidualRow {
  std::string trial, channel, phase;
  double time_s = 0.0, before = 0.0;
  double after = 0.0;  // held out
  double noise_sd = 0.0;
};

struct Bound {  // of an effect that was looked for and not found
  std::string id;
  std::string parameter;
  double value = 0.0;     // 95 % upper bound of its magnitude
  double typicals = 0.0;  // the same, of the size at which the effect matters
};

// One number that the answer rests on.
struct BelievedNumber {
  std::string key;               // "axis.inertia_kg_m2"
  double low = 0.0, high = 0.0;  // over the trials
  std::string unit{};
  std::string said_by{};
  // As far as it may be off, by the way it was written: half a unit of its last digit; a default that nobody
  // stated, by its whole size.
  double usual_error = 0.0;
  // Beyond this error the recordings would contradict it (95 %), what differs from trial to trial fitted
  // along; infinite: they do not depend on it.
  double error_that_shows = 0.0;

  double size() const { return low < 0.0 && -low > high ? -low : high; }
  bool matters() const { return usual_error >= error_that_shows; }
};

struct Curve {
  std::string variable;
  std::vector<double> at, value, sd;
};

struct UnknownForce {
  std::string port;
  std::string quantity;  // that acts there, with its unit: force_N
  double p_value = 1.0;
  double share = 0.0;  // of what can be explained at all
  Curve curve;
};

// The trial worth doing next.
struct NextTrial {
  // "split" a class, "sharpen" intervals, "map" an unknown force, "bound" what is absent, "repeat" after a
  // repair; empty where no trial is recommended.
  std::string purpose;
  std::string why;
  std::string kind;
  std::map<std::string, double> setup;
  std::map<std::string, std::string> words;  // set-up keys that are no numbers: profile
  // Chance that one such trial tells all rivals from what was found, and at least one; 0: not a question of
  // telling.
  double settles = 0.0, splits = 0.0;
  // What it would record, by two explanations; empty where there is only one.
  std::string channel;
  std::string first, second;
  double floor = 0.0;
  std::vector<double> time_s, by_first, by_second;
};

// What a fit says of something that differs from trial to trial, without any effect and with those found:
// mean and standard deviation over the trials, beside the one believed.
struct TrialToTrial {
  std::string name;  // ends in its unit
  double believed_sd = 0.0;
  double mean_before = 0.0, sd_before = 0.0;
  double mean_after = 0.0, sd_after = 0.0;
};

struct Diagnosis {
  Verdict verdict = Verdict::insufficient_data;
  Detail detail = Detail::none;
  std::map<std::string, double> noise_floor;
  std::vector<Where> where;
  std::vector<FoundEffect> effects;
  double gap_closed = 1.0;       // by the effects on the list, of what can be explained
  std::vector<ChannelFit> fits;  // the channel that shows most first
  std::vector<Bound> absent;
  std::vector<BelievedNumber> belief;
  std::vector<UnknownForce> unknown;
  std::vector<std::string> notes;  // missing channels, trials left out, weaker tests
  std::vector<PhaseError> phase_errors;
  std::vector<TrialToTrial> trial_to_trial;
  std::vector<Trace> traces;
  std::vector<ResidualRow> residuals;
  NextTrial next;
  SimpleAnswers simple;
  std::string corrected_model_toml;
  std::size_t trials = 0;
  std::uint64_t simulations = 0;
  double seconds = 0.0;
  std::vector<std::string> log;  // how the search went
};

}  // namespace sandhopper::diagnose
