#include "tools/diagnose/answer/corrected_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "config/hint.hpp"

namespace sandhopper::diagnose {
namespace {

using Numbers = std::map<std::string, double>;

// Text of a number that TOML reads as a float.
std::string real_text(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".einf") == std::string::npos) text += ".0";
  return text;
}

// Key of nominal.toml with the name of the first parameter. Empty if there is none, or more than one.
std::string key_of(const Candidate& candidate, const Numbers& numbers) {
  const auto& name = candidate.parameters.front().name;
  const auto& usual = candidate.effect->belief_key;
  if (last_key(usual) == name) return usual;
  std::string found;
  for (const auto& [key, value] : numbers) {
    if (last_key(key) != name || key.starts_with("sensors.") || key.starts_with("spread.")) continue;
    if (!found.empty()) return {};
    found = key;
  }
  return found;
}

bool trials_differ(const Recordings& recordings, const std::string& key) {
  return std::any_of(recordings.beliefs.begin(), recordings.beliefs.end(), [&](const Belief& belief) {
    return belief.value(key, 0.0) != recordings.belief.value(key, 0.0);
  });
}

class Corrected {
 public:
  Corrected(const Recordings& recordings, const Problem& problem)
      : recordings_(recordings),
        problem_(problem),
        numbers_(recordings.belief.numbers),
        effects_(recordings.belief.effects) {}

  void add(FoundEffect found) {
    std::erase_if(found.parameters, [](const FoundParameter& p) { return p.derived; });
    const auto candidate =
        std::find_if(problem_.candidates.begin(), problem_.candidates.end(), [&](const Candidate& c) {
          return c.effect->id == found.id && c.channel == found.channel &&
                 c.parameters.size() == found.parameters.size();
        });
    if (candidate == problem_.candidates.end()) return comment(found);
    if (!as_keys(*candidate, found)) as_effect(*candidate, found);
  }

  bool differs() const {
    return numbers_ != recordings_.belief.numbers || effects_ != recordings_.belief.effects;
  }

  std::string text() const {
    std::map<std::string, std::string> tables;
    for (const auto& [key, value] : numbers_) tables[table_of(key)] += line(key, value);
    std::string text = comments_;
    for (const auto& [table, lines] : tables) {
      if (!table.empty()) text += fmt::format("\n[{}]\n", table);
      text += lines;
    }
    if (!effects_.empty()) text += "\n[effects]\n";
    for (const auto& [label, parameters] : effects_) {
      std::string inside;
      for (const auto& [name, value] : parameters)
        inside += (inside.empty() ? " " : ", ") + name + " = " + real_text(value);
      text += fmt::format("\"{}\" = {{{} }}\n", label, inside);
    }
    return text;
  }

 private:
  bool as_keys(const Candidate& candidate, const FoundEffect& found) {
    if (candidate.effect->as_keys) {
      std::vector<double> values;
      for (std::size_t i = 0; i < found.parameters.size(); ++i)
        values.push_back(candidate.parameters[i].value_of(found.parameters[i].value));
      Numbers changed = numbers_;
      if (!candidate.effect->as_keys(problem_.context, values, changed)) return false;
      for (const auto& [key, value] : changed)
        if (value != recordings_.belief.value(key, value) && trials_differ(recordings_, key)) return false;
      numbers_ = std::move(changed);
      return true;
    }
    if (found.parameters.size() != 1) return false;
    const auto key = key_of(candidate, numbers_);
    if (key.empty() || trials_differ(recordings_, key)) return false;
    numbers_[key] = found.parameters.front().value;
    return true;
  }

  void as_effect(const Candidate& candidate, const FoundEffect& found) {
    std::string label = candidate.label();
    for (int i = 2; effects_.contains(label); ++i) label = fmt::format("{}#{}", candidate.label(), i);
    for (const auto& p : found.parameters) effects_[label][p.name] = p.value;
  }

  void comment(const FoundEffect& found) {
    comments_ += fmt::format("# {}: {}  ({})\n", found.id, found.statement, found.equation);
    for (const auto& p : found.parameters)
      comments_ += fmt::format("#   {} = {}  # {} to {}\n", p.name, p.value, p.low, p.high);
  }

  static std::string table_of(const std::string& key) {
    const auto dot = key.find('.');
    return dot == std::string::npos ? "" : key.substr(0, dot);
  }
  static std::string line(const std::string& key, double value) {
    const auto name = last_key(key);
    if (name == "rigid") return fmt::format("rigid = {}\n", value != 0.0);
    if (name == "motor_count") return fmt::format("motor_count = {}\n", static_cast<int>(value));
    return fmt::format("{} = {}\n", name, real_text(value));
  }

  const Recordings& recordings_;
  const Problem& problem_;
  Numbers numbers_;
  std::map<std::string, Numbers> effects_;
  std::string comments_;
};

}  // namespace

std::string corrected_model(const Recordings& recordings, const Problem& problem,
                            const Diagnosis& diagnosis) {
  Corrected corrected(recordings, problem);
  for (const auto& found : diagnosis.effects) corrected.add(found);
  return corrected.differs() ? corrected.text() : "";
}

}  // namespace sandhopper::diagnose
