#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/conceal/core/plant.hpp"

namespace sandhopper::conceal {

// Kind of a concealed campaign: nothing hidden (null, decoy), one effect (single), two or three (several), an
// unlisted effect (unknown), one effect that the apparatus cannot distinguish from another
// (indistinguishable).
enum class Kind { null, decoy, single, several, unknown, indistinguishable };

const char* name_of(Kind kind);
// Empty if there is no such kind.
std::optional<Kind> kind_named(const std::string& name);

// A request; everything left empty is drawn.
struct Request {
  std::uint64_t seed = 1;
  std::string plant;
  std::optional<Kind> kind;
  std::string effect;
  std::optional<double> size;
  int trials = 12;

  Json to_json() const;
  static Request from_json(const Json& json);
};

// One effect to hide, with the random numbers for its parameters.
struct HiddenEffect {
  EffectInfo info;
  double size;  // relative to typical
  Random random;
};

// One concealed campaign, fully determined by request and index.
struct Case {
  const Plant* plant = nullptr;
  Kind kind = Kind::null;
  std::vector<HiddenEffect> hidden;
  Json effects = Json::array();  // For the answer: id, parameters, size_relative.
  Json unknown_port;             // null if the hidden effect is a listed one
  std::optional<std::size_t> restriction;
  std::vector<std::string> ambiguity;
  std::vector<Setup> setups;
  std::string dead_channel;  // This channel is recorded without samples.
  bool gaps = false;
  bool foreign_names = false;
  Random apparatus{0};
  Random recording{0};
  std::unique_ptr<Bench> bench;  // apparatus with all hidden effects
};

// Throws std::invalid_argument if there is no such plant or effect.
void check(const Request& request);

// Throws like check(), and if the requested effect does nothing on any drawn apparatus.
Case make_case(const Request& request, std::uint64_t index);

// The apparatus of a case with the given hidden effects only.
std::unique_ptr<Bench> build(const Case& c, const std::vector<HiddenEffect>& hidden);

// A trial as it is written to the campaign's folder, with dead channel and gaps.
Table record(const Case& c, const Bench& bench, const Setup& setup, const TrialRandom& trial);

}  // namespace sandhopper::conceal
