// Fuzz target of JSON: sums of a stride campaign's parts, and diagnoses of other tools that a benchmark
// scores.
#include <nlohmann/json.hpp>

#include "tests/fuzz/fuzz.hpp"
#include "tools/benchmark/records.hpp"
#include "tools/experiment/stride_campaign.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace sandhopper;
  try {
    const auto json = nlohmann::ordered_json::parse(data, data + size);
    StrideCampaign campaign;
    campaign.add(json.at("cells").get<StrideCampaign>());
    static_cast<void>(nlohmann::ordered_json(campaign).dump());
  } catch (const nlohmann::json::exception&) {
  }
  const fuzz::ScratchFile file({data, size}, "diagnosis.json");
  static_cast<void>(benchmark::read_diagnosis(file.path()));
  return 0;
}
