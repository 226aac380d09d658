#include "tools/diagnose/answer/corrected_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "config/edit.hpp"
#include "config/hint.hpp"
#include "config/problem.hpp"

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
    if (last_key(key) != name || key.starts_with("sensors.") || states_uncertainty(key)) continue;
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
    const Numbers before = numbers_;
    if (!as_keys(*candidate, found)) as_effect(*candidate, found);
    for (const auto& [key, value] : numbers_)
      if (const auto it = before.find(key); it == before.end() || it->second != value)
        changed_by_[key] = candidate->label();
  }

  bool differs() const {
    return numbers_ != recordings_.belief.numbers || effects_ != recordings_.belief.effects;
  }

  std::string text() const {
    if (recordings_.model_text) try {
        return on_top_of(*recordings_.model_text);
      } catch (const ConfigError&) {  // A table that is written in an unusual way cannot be added to.
      }
    return every_number();
  }

 private:
  // The author's own text with the changed and added keys, each with a remark.
  std::string on_top_of(const std::string& own) const {
    ConfigEditor editor("nominal.toml", own);
    for (const auto& [key, id] : changed_by_) {
      const double value = numbers_.at(key);
      const auto usual = recordings_.belief.numbers.find(key);
      const auto before = usual == recordings_.belief.numbers.end() ? "not stated" : real_text(usual->second);
      const bool stated = editor.has(key);
      if (stated)
        editor.set(key, value_text(key, value));
      else
        editor.add(table_of(key), fmt::format("{} = {}", last_key(key), value_text(key, value)));
      editor.remark(key, fmt::format("found by hop diagnose, {}: {} before{}", id, before,
                                     stated ? "" : ", by default"));
    }
    for (const auto& [label, parameters] : effects_)
      if (!recordings_.belief.effects.contains(label))
        editor.add("effects", effect_line(label, parameters) + "   # found by hop diagnose");
    return comments_ + editor.text();
  }

  std::string every_number() const {
    std::map<std::string, std::string> tables;
    for (const auto& [key, value] : numbers_) tables[table_of(key)] += line(key, value);
    std::string text = comments_;
    for (const auto& [table, lines] : tables) {
      if (!table.empty()) text += fmt::format("\n[{}]\n", table);
      text += lines;
    }
    if (!effects_.empty()) text += "\n[effects]\n";
    for (const auto& [label, parameters] : effects_) text += effect_line(label, parameters) + "\n";
    return text;
  }

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
  static std::string value_text(const std::string& key, double value) {
    const auto name = last_key(key);
    if (name == "rigid") return value != 0.0 ? "true" : "false";
    return name == "motor_count" ? std::to_string(static_cast<int>(value)) : real_text(value);
  }
  static std::string line(const std::string& key, double value) {
    return fmt::format("{} = {}\n", last_key(key), value_text(key, value));
  }
  static std::string effect_line(const std::string& label, const Numbers& parameters) {
    std::string inside;
    for (const auto& [name, value] : parameters)
      inside += (inside.empty() ? " " : ", ") + name + " = " + real_text(value);
    return fmt::format("\"{}\" = {{{} }}", label, inside);
  }

  const Recordings& recordings_;
  const Problem& problem_;
  Numbers numbers_;
  std::map<std::string, Numbers> effects_;
  std::map<std::string, std::string> changed_by_;  // key: effect
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
