#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/conceal/core/plant.hpp"

namespace sandhopper::conceal {

enum class Kind { null, decoy, single, several, unknown, indistinguishable };

const char* name_of(Kind kind);
std::optional<Kind> kind_named(const std::string& name);

// What is asked for; what is left open is drawn.
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

struct HiddenEffect {
  EffectInfo info;
  double size;  // relative to typical
  Random random;
};

// One concealed campaign: the same for the same request and index.
struct Case {
  const Plant* plant = nullptr;
  Kind kind = Kind::null;
  std::vector<HiddenEffect> hidden;
  Json effects = Json::array();  // of the answer: id, parameters, size_relative
  Json unknown_port;             // null where the truth is on the list
  std::optional<std::size_t> restriction;
  std::vector<std::string> ambiguity;
  std::vector<Setup> setups;
  std::string dead_channel;  // recorded empty throughout
  bool gaps = false;
  bool foreign_names = false;
  Random apparatus{0};
  Random recording{0};
  std::unique_ptr<Bench> bench;  // with all that is hidden
};

// Throws std::invalid_argument when the request names a plant or an effect that there is not.
void check(const Request& request);

// Throws as check() does, and when the effect asked for does nothing on any apparatus.
Case make_case(const Request& request, std::uint64_t index);

// The apparatus of a case with some of what is hidden in it, or nothing.
std::unique_ptr<Bench> build(const Case& c, const std::vector<HiddenEffect>& hidden);

// A trial as it goes into the campaign's folder: dead channel and gaps included.
Table record(const Case& c, const Bench& bench, const Setup& setup, const Random& trial);

}  // namespace sandhopper::conceal
