#include "tools/conceal/core/keys.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace sandhopper::conceal {

double six_digits(double value) { return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr); }

std::string toml_value(const Json& value) {
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_string()) return fmt::format("\"{}\"", value.get<std::string>());
  if (value.is_number_integer()) return fmt::format("{}", value.get<long long>());
  auto text = fmt::format("{:.6g}", value.get<double>());
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string to_toml(const Belief& belief) {
  std::string text = fmt::format("gravity_mps2 = {}\n", toml_value(belief.gravity_mps2));
  for (const auto& [name, table] : belief.tables) {
    text += fmt::format("\n[{}]\n", name);
    for (const auto& [key, value] : table.items()) text += fmt::format("{} = {}\n", key, toml_value(value));
  }
  return text;
}

}  // namespace sandhopper::conceal
