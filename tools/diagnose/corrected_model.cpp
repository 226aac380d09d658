#include "tools/diagnose/corrected_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace sandhopper::diagnose {
namespace {

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

// A number that TOML reads as a real.
std::string real_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".einf") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

std::string corrected_model(const Belief& belief, const std::vector<Effect>& effects,
                            const Diagnosis& diagnosis) {
  std::map<std::string, double> numbers = belief.numbers;
  std::string comments;
  for (const auto& found : diagnosis.effects) {
    const auto effect =
        std::find_if(effects.begin(), effects.end(), [&](const Effect& e) { return e.id == found.id; });
    bool expressed = false;
    if (effect != effects.end() && !effect->belief_key.empty() && !found.parameters.empty() &&
        last_part(effect->belief_key) == found.parameters.front().name) {
      numbers[effect->belief_key] = found.parameters.front().value;
      expressed = true;
    }
    if (expressed) continue;
    comments += fmt::format("# {}: {}  ({})\n", found.id, found.statement, found.equation);
    for (const auto& p : found.parameters)
      comments += fmt::format("#   {} = {}  # {} to {}\n", p.name, p.value, p.low, p.high);
  }
  std::map<std::string, std::string> tables;
  for (const auto& [key, value] : numbers) {
    const auto dot = key.find('.');
    const std::string table = dot == std::string::npos ? "" : key.substr(0, dot);
    if (last_part(key) == "rigid") {
      tables[table] += fmt::format("rigid = {}\n", value != 0.0);
    } else if (last_part(key) == "motor_count") {
      tables[table] += fmt::format("motor_count = {}\n", static_cast<int>(value));
    } else {
      tables[table] += fmt::format("{} = {}\n", last_part(key), real_text(value));
    }
  }
  std::string text = comments;
  for (const auto& [table, lines] : tables) text += (table.empty() ? "" : "\n[" + table + "]\n") + lines;
  return text;
}

}  // namespace sandhopper::diagnose
