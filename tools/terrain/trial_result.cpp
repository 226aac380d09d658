#include "tools/terrain/trial_result.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "terrain/none.hpp"
#include "terrain/trial_statistics.hpp"
#include "tools/terrain/mean_json.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;

double number_of(const Json& json) { return json.is_null() ? kNone : json.get<double>(); }

template <NamedEnum E>
E enum_of(const Json& json) {
  const auto& names = EnumNames<E>::value;
  const auto found = std::find(names.begin(), names.end(), json.get_ref<const std::string&>());
  return static_cast<E>(found == names.end() ? 0 : found - names.begin());
}

}  // namespace

const TrialQuantity* TrialResult::find(std::string_view name) const {
  const auto found =
      std::find_if(quantities.begin(), quantities.end(), [&](const auto& q) { return q.name == name; });
  return found == quantities.end() ? nullptr : &*found;
}

double TrialResult::value(std::string_view name) const {
  const auto* quantity = find(name);
  return quantity == nullptr || !quantity->invalid.empty() ? kNone : quantity->value;
}

double TrialResult::setup_number(std::string_view key) const {
  const auto found =
      std::find_if(setup.begin(), setup.end(), [&](const auto& entry) { return entry.first == key; });
  return found == setup.end() ? kNone : found->second;
}

TrialResult result_of(const CampaignTrial& trial, const TrialRecording& recording) {
  TrialResult result;
  result.index = trial.index;
  result.trial = trial.name;
  result.kind = name_of(trial.kind);
  result.usable = recording.usable();
  result.findings = recording.findings;
  for (const auto& entry : trial.setup)
    if (const auto* value = std::get_if<double>(&entry.value)) result.setup.emplace_back(entry.key, *value);
  return result;
}

Json to_json(const Finding& f) {
  return {{"kind", name_of(f.kind)}, {"severity", name_of(f.severity)},
          {"file", f.file},          {"line", f.line},
          {"column", f.column},      {"channel", f.channel},
          {"what", f.what},          {"cure", f.cure}};
}

Finding finding_from_json(const Json& json) {
  return {enum_of<FindingKind>(json.at("kind")),
          enum_of<FindingSeverity>(json.at("severity")),
          json.at("file"),
          json.at("line"),
          json.at("column"),
          json.at("channel"),
          json.at("what"),
          json.at("cure")};
}

Json to_json(const TrialResult& r) {
  Json setup = Json::object(), quantities = Json::object(), series = Json::object(), findings = Json::array();
  for (const auto& [key, value] : r.setup) setup[key] = number_or_null(value);
  for (const auto& q : r.quantities) {
    quantities[q.name] = {{"value", number_or_null(q.value)},
                          {"standard_error", number_or_null(q.standard_error)}};
    if (!q.invalid.empty()) quantities[q.name]["invalid"] = q.invalid;
  }
  for (const auto& [name, values] : r.series) {
    auto& list = series[name] = Json::array();
    for (const double value : values) list.push_back(number_or_null(value));
  }
  for (const auto& finding : r.findings) findings.push_back(to_json(finding));
  return {{"index", r.index},     {"trial", r.trial},         {"kind", r.kind},
          {"usable", r.usable},   {"setup", setup},           {"quantities", quantities},
          {"findings", findings}, {"ruled_out", r.ruled_out}, {"series", series}};
}

TrialResult trial_result_from_json(const Json& json) {
  TrialResult r;
  r.index = json.at("index");
  r.trial = json.at("trial");
  r.kind = json.at("kind");
  r.usable = json.at("usable");
  for (const auto& [key, value] : json.at("setup").items()) r.setup.emplace_back(key, number_of(value));
  for (const auto& [name, q] : json.at("quantities").items())
    r.quantities.push_back(
        {name, number_of(q.at("value")), number_of(q.at("standard_error")), q.value("invalid", "")});
  for (const auto& finding : json.at("findings")) r.findings.push_back(finding_from_json(finding));
  r.ruled_out = json.at("ruled_out").get<std::vector<std::string>>();
  for (const auto& [name, values] : json.at("series").items())
    for (const auto& value : values) r.series[name].push_back(number_of(value));
  return r;
}

std::vector<double> values_of(std::span<const TrialResult* const> results, std::string_view name) {
  std::vector<double> values;
  for (const auto* result : results)
    if (const double value = result->value(name); std::isfinite(value)) values.push_back(value);
  return values;
}

std::vector<PooledQuantity> pool_quantities(std::span<const TrialResult* const> results) {
  std::vector<PooledQuantity> pooled;
  for (const auto* result : results)
    for (const auto& quantity : result->quantities)
      if (std::none_of(pooled.begin(), pooled.end(), [&](const auto& p) { return p.name == quantity.name; }))
        pooled.push_back({.name = quantity.name});
  for (auto& quantity : pooled) {
    const auto mean = mean_over_trials(values_of(results, quantity.name));
    quantity.trials = mean.trials;
    quantity.value = mean.value;
    quantity.ci95_low = mean.ci95_low;
    quantity.ci95_high = mean.ci95_high;
    quantity.standard_deviation = mean.standard_deviation;
  }
  return pooled;
}

}  // namespace sandhopper
