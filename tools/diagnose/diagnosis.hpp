#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace sandhopper::diagnose {

// What diagnosis.json says; see tools/diagnose/README.md.
struct FoundParameter {
  std::string name;
  double value = 0.0;
  double low = 0.0, high = 0.0;  // 95 %
};

struct FoundEffect {
  std::string id;
  std::string channel;
  std::string statement;
  std::string equation;
  std::vector<FoundParameter> parameters;
  double probability = 0.0;
  double heldout_gain = 0.0;  // share of the held-out excess that goes with it
  double p_value = 1.0;
  double typicals = 0.0;
  std::vector<std::string> indistinguishable_from;
};

struct Where {
  std::string channel;
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

struct ChannelFit {
  std::string channel;
  ErrorBeforeAfter train, heldout;
  double floor = 0.0;
};

struct Bound {  // of an effect that was looked for and not found
  std::string id;
  std::string parameter;
  double value = 0.0;  // 95 % upper bound of its magnitude
};

struct Curve {
  std::string variable;
  std::vector<double> at, value, sd;
};

struct UnknownForce {
  std::string port;
  double p_value = 1.0;
  double share = 0.0;  // of what can be explained at all
  Curve curve;
};

struct Diagnosis {
  std::string verdict;
  std::string detail;
  std::map<std::string, double> noise_floor;
  std::vector<Where> where;
  std::vector<FoundEffect> effects;
  std::vector<ChannelFit> fits;  // the channel that shows most first
  std::vector<Bound> absent;
  std::vector<UnknownForce> unknown;
  std::vector<std::string> notes;  // missing channels, trials left out, weaker tests
  std::string next_why;
  std::map<std::string, double> next_setup;
  std::string next_kind;
  std::string corrected_model_toml;
  std::size_t trials = 0;
  std::uint64_t simulations = 0;
  double seconds = 0.0;
  std::vector<std::string> log;  // how the search went
};

}  // namespace sandhopper::diagnose
