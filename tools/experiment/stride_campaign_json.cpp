#include "tools/experiment/stride_campaign.hpp"

namespace sandhopper {
namespace {

// Fields of the sums, listed once for writing and reading.
template <class Sums, class Visitor>
void way_fields(Sums& s, Visitor&& visit) {
  visit("strides", s.strides);
  visit("ratio_sum", s.ratio);
  visit("ratio_squared_sum", s.ratio_squared);
  visit("covered", s.covered);
  visit("valid", s.valid);
  visit("valid_covered", s.valid_covered);
  visit("groups", s.groups);
  visit("group_error_sum", s.group_error);
  visit("worst_group_error", s.worst_group_error);
}

template <class Sums, class Visitor>
void cell_fields(Sums& s, Visitor&& visit) {
  visit("strides", s.strides);
  visit("incomplete", s.incomplete);
  visit("simulated_s", s.simulated_s);
}

}  // namespace

void to_json(nlohmann::ordered_json& json, const StrideCampaign& campaign) {
  json = nlohmann::ordered_json::array();
  for (std::size_t c = 0; c < campaign.cells.size(); ++c) {
    const auto& definition = hop_cells()[c];
    auto& cell = json.emplace_back();
    cell["touchdown_speed_mps"] = definition.touchdown_speed_mps;
    cell["compression_stiffness_N_per_m"] = definition.compression_stiffness_N_per_m;
    cell_fields(campaign.cells[c], [&](const char* name, double value) { cell[name] = value; });
    for (std::size_t w = 0; w < kWays; ++w)
      way_fields(campaign.cells[c].ways[w], [&](const char* name, double value) {
        cell["ways"][std::string(kWayNames[w])][name] = value;
      });
  }
}

void from_json(const nlohmann::ordered_json& json, StrideCampaign& campaign) {
  campaign = {};
  for (std::size_t c = 0; c < campaign.cells.size(); ++c) {
    const auto& cell = json.at(c);
    cell_fields(campaign.cells[c], [&](const char* name, double& value) { value = cell.at(name); });
    for (std::size_t w = 0; w < kWays; ++w)
      way_fields(campaign.cells[c].ways[w], [&](const char* name, double& value) {
        value = cell.at("ways").at(std::string(kWayNames[w])).at(name);
      });
  }
}

}  // namespace sandhopper
