#include <algorithm>
#include <ostream>

#include "tools/terrain/campaign_analysis.hpp"

namespace sandhopper {

using Json = nlohmann::ordered_json;

Json to_json(const CampaignResults& r) {
  Json findings = Json::array();
  for (const auto& finding : r.findings) findings.push_back(to_json(finding));
  return {{"campaign", r.campaign},
          {"plant", name_of(r.plant)},
          {"trials_named", r.trials},
          {"part", {{"number", r.part}, {"of", r.parts}}},
          {"findings", findings}};
}

void write_results(std::ostream& out, const Json& head, const CampaignResults& r) {
  const auto text = [](const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  std::string start = text(head);
  start.pop_back();  // the closing brace is written after the trials
  out << start << (head.empty() ? "" : ",\n") << "\"trials\":[";
  for (std::size_t i = 0; i < r.results.size(); ++i)
    out << (i == 0 ? "\n" : ",\n") << text(to_json(r.results[i]));
  out << "\n]}\n";
}

CampaignResults campaign_results_from_json(const Json& json) {
  CampaignResults r;
  r.campaign = json.at("campaign");
  const std::string plant = json.at("plant");
  const auto& names = EnumNames<CampaignPlant>::value;
  r.plant = static_cast<CampaignPlant>(std::find(names.begin(), names.end(), plant) - names.begin());
  r.trials = json.at("trials_named");
  r.part = json.at("part").at("number");
  r.parts = json.at("part").at("of");
  for (const auto& finding : json.at("findings")) r.findings.push_back(finding_from_json(finding));
  for (const auto& trial : json.at("trials")) r.results.push_back(trial_result_from_json(trial));
  return r;
}

}  // namespace sandhopper
