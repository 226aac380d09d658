#include "tools/explain/explanation_json.hpp"

#include <cmath>
#include <sstream>

namespace sandhopper {
namespace {

using Json = nlohmann::ordered_json;

Json words_of(const std::string& text) {
  Json words = Json::array();
  std::istringstream in(text);
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

Json fault_json(const ExplainedFault& f) {
  const FaultEntry& entry = entry_of(f.fault);
  return {{"code", static_cast<int>(f.fault)},
          {"name", std::string(entry.name)},
          {"time_s", f.time_s},
          {"device", f.reading.device},
          {"quantity", f.reading.quantity},
          {"unit", f.reading.unit},
          {"value", std::isfinite(f.reading.value) ? Json(f.reading.value) : Json(nullptr)},
          {"value_text", f.reading.value_text},
          {"limits", f.reading.limits},
          {"limit_key", f.reading.limit_key},
          {"limit_text", f.reading.limit_text},
          {"meaning", std::string(entry.meaning)},
          {"reaction", std::string(name_of(entry.reaction))},
          {"latch", std::string(name_of(entry.latch))},
          {"cure", std::string(entry.cure)},
          {"channels", words_of(f.reading.channels)},
          {"lines", f.reading.lines}};
}

}  // namespace

Json explanation_json(const Explanation& e) {
  Json json{{"title", e.title},        {"date", e.date},         {"cause", std::string(name_of(e.cause))},
            {"before_s", e.before_s},  {"after_s", e.after_s},   {"missing_cycles", e.missing_cycles},
            {"faults", Json::array()}, {"steps", Json::array()}, {"notes", e.notes}};
  for (const auto& fault : e.faults) json["faults"].push_back(fault_json(fault));
  for (const auto& step : e.steps)
    json["steps"].push_back({{"from_s", step.from_s},
                             {"to_s", step.to_s},
                             {"state", std::string(name_of(step.state))},
                             {"drives", step.drives}});
  return json;
}

}  // namespace sandhopper
