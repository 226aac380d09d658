#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace sandhopper::conceal {

using Json = nlohmann::ordered_json;

// The set-up of one trial: keys of a [[trial]] (tools/docs/guide/recordings.md) except the file.
struct Setup {
  Json keys = Json::object();

  std::string kind() const { return keys.value("kind", ""); }
  double number(const std::string& key, double otherwise) const { return keys.value(key, otherwise); }
  std::string text(const std::string& key, const std::string& otherwise) const {
    return keys.value(key, otherwise);
  }
};

// Contents of nominal.toml: gravity at the top, then tables of keys.
struct Belief {
  double gravity_mps2 = 9.81;
  std::vector<std::pair<std::string, Json>> tables;
};

std::string toml_value(const Json& value);  // Number (six significant digits), text or boolean.
double six_digits(double value);            // The number that a reader of toml_value gets.
std::string to_toml(const Belief& belief);

}  // namespace sandhopper::conceal
