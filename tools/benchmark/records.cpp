#include "tools/benchmark/records.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace sandhopper::benchmark {
namespace {

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  try {
    return nlohmann::json::parse(in);
  } catch (const nlohmann::json::exception&
               error) {  // A number too large for a double gives out_of_range, not parse_error.
    throw std::runtime_error(file.string() + " is not JSON: " + error.what());
  }
}

std::optional<double> number(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() || !found->is_number() ? std::nullopt : std::optional(found->get<double>());
}

std::vector<std::string> texts(const nlohmann::json& json, const char* key) {
  std::vector<std::string> all;
  const auto found = json.find(key);
  if (found != json.end() && found->is_array())
    for (const auto& one : *found)
      all.push_back(one.is_object() ? one.value("id", "") : one.get<std::string>());
  return all;
}

// Entries without the names of a channel and a phase are left out.
std::set<Cell> cells_of(const nlohmann::json& json) {
  std::set<Cell> cells;
  for (const auto& one : json) {
    if (!one.is_object() || !one.contains("channel") || !one.contains("phase")) continue;
    const auto &channel = one["channel"], &phase = one["phase"];
    if (channel.is_string() && phase.is_string()) cells.insert({channel, phase});
  }
  return cells;
}

Truth truth_of(const nlohmann::json& json, std::string name) {
  Truth t;
  t.name = std::move(name);
  t.plant = json.at("plant");
  t.kind = json.at("kind");
  for (const auto& effect : json.at("effects")) {
    Truth::Effect e{effect.at("id"), effect.at("size_relative"), {}};
    for (const auto& [key, value] : effect.at("parameters").items())
      if (value.is_number())
        e.parameters[key] = value.get<double>();
      else if (key == "channel" && value.is_string())
        e.channel = value;
    if (effect.contains("cells") && effect["cells"].is_array()) e.cells = cells_of(effect["cells"]);
    t.effects.push_back(std::move(e));
  }
  if (json.at("unknown_port").is_string()) t.unknown_port = json["unknown_port"].get<std::string>();
  t.alike = texts(json, "class");
  if (json.contains("visibility")) t.visibility = json["visibility"].value("ratio", 0.0);
  return t;
}

Claim claim_of(const nlohmann::json& json) {
  Claim c;
  c.id = json.value("id", "");
  c.probability = number(json, "probability").value_or(0.0);
  c.alike = texts(json, "indistinguishable_from");
  if (!json.contains("parameters") || !json["parameters"].is_object()) return c;
  for (const auto& [key, value] : json["parameters"].items()) {
    if (!value.is_object() || !number(value, "value")) continue;
    Claim::Value v{*number(value, "value")};
    const auto interval = value.find("ci95");
    if (interval != value.end() && interval->is_array() && interval->size() == 2 &&
        (*interval)[0].is_number() && (*interval)[1].is_number())
      v.low = (*interval)[0], v.high = (*interval)[1], v.has_interval = true;
    c.parameters[key] = v;
  }
  return c;
}

}  // namespace

bool Truth::holds(const std::string& id) const {
  return std::any_of(effects.begin(), effects.end(), [&](const Effect& e) { return e.id == id; });
}

std::set<Cell> Truth::cells() const {
  std::set<Cell> all;
  for (const auto& effect : effects) {
    if (!effect.cells) return {};
    all.insert(effect.cells->begin(), effect.cells->end());
  }
  return all;
}

bool Claim::covers(const std::string& other) const {
  return id == other || std::find(alike.begin(), alike.end(), other) != alike.end();
}

std::vector<Truth> read_truths(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) throw std::runtime_error(folder.string() + " is not a folder");
  std::vector<Truth> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    try {
      all.push_back(truth_of(read_json(entry.path()), entry.path().stem().string()));
    } catch (const nlohmann::json::exception& error) {
      throw std::runtime_error(entry.path().string() + " is not an answer of hop conceal: " + error.what());
    }
  }
  std::sort(all.begin(), all.end(), [](const Truth& a, const Truth& b) { return a.name < b.name; });
  return all;
}

std::optional<Diagnosis> read_diagnosis(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::exists(file, none) || std::filesystem::file_size(file, none) == 0)
    return std::nullopt;
  nlohmann::json json;
  try {
    json = read_json(file);
  } catch (const std::runtime_error&) {
    return std::nullopt;  // killed while writing
  }
  if (!json.is_object() || !json.contains("verdict") || !json["verdict"].is_string()) return std::nullopt;
  Diagnosis d;
  d.verdict = json["verdict"];
  if (json.contains("detail") && json["detail"].is_string()) d.detail = json["detail"];
  if (json.contains("effects") && json["effects"].is_array())
    for (const auto& effect : json["effects"]) d.claims.push_back(claim_of(effect));
  std::stable_sort(d.claims.begin(), d.claims.end(),
                   [](const Claim& a, const Claim& b) { return a.probability > b.probability; });
  if (json.contains("absent") && json["absent"].is_array())
    for (const auto& bound : json["absent"])
      for (const char* key : {"upper_bound", "lower_bound"})
        if (const auto value = bound.is_object() ? number(bound, key) : std::nullopt)
          d.absent.push_back({bound.value("id", ""), bound.value("parameter", ""), *value,
                              key == std::string_view("lower_bound")});
  if (json.contains("where") && json["where"].is_array()) d.where = cells_of(json["where"]);
  if (json.contains("baselines") && json["baselines"].is_object())
    for (const auto& [name, one] : json["baselines"].items())
      if (one.is_object() && one.contains("id") && one["id"].is_string()) d.baselines[name] = one["id"];
  if (json.contains("fit") && json["fit"].is_object() && json["fit"].contains("heldout")) {
    const auto& heldout = json["fit"]["heldout"];
    if (heldout.is_object()) d.heldout_after = number(heldout, "after"), d.floor = number(heldout, "floor");
  }
  if (json.contains("next_trial") && json["next_trial"].is_object()) {
    const auto& next = json["next_trial"];
    const auto setup = next.value("setup", nlohmann::json());
    // A set-up that holds no more than its kind is a test on the bench, which the apparatus does not have.
    const bool is_trial = setup.is_object() && setup.size() > setup.count("kind");
    d.asks_for_a_split = is_trial && next.value("purpose", nlohmann::json("split")) == "split";
  }
  return d;
}

std::optional<double> UpperBound::size_of(const Truth::Effect& effect) const {
  if (id != effect.id && (effect.channel.empty() || id != effect.id + "[" + effect.channel + "]"))
    return std::nullopt;
  // A change is compared with the number itself where the belief holds none: both start at 0.
  const auto without_change = [](std::string name) {
    if (const auto at = name.find("_change"); at != std::string::npos) name.erase(at, 7);
    return name;
  };
  for (const auto& [name, value] : effect.parameters)
    if (without_change(name) == without_change(parameter)) {
      const bool is_new =
          name != parameter && name == without_change(parameter);  // not a change of the belief
      return is_new ? std::nullopt : std::optional(std::abs(value));
    }
  if (effect.parameters.size() == 1) return std::abs(effect.parameters.begin()->second);
  return std::nullopt;
}

}  // namespace sandhopper::benchmark
