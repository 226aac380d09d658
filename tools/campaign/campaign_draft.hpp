#pragma once
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// Neither a column's name nor its unit belongs to one plant alone.
struct PlantNotTold : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A campaign for files that another program wrote, to be corrected by their owner.
struct CampaignDraft {
  CampaignPlant plant{};
  std::vector<std::string> said{};  // what the files were taken for, in sentences
  std::string campaign_toml{};
  std::string nominal_toml{};
};

// Looks at the first file: how it is written (csv_layout.hpp), which column is the time and which may be
// which channel, by unit and name; `plant` is guessed from these where it is not given. Both texts hold every
// key, with unit and a comment; keys that state physics are remarks until somebody wants them. Files are
// named relative to `folder`. Throws std::runtime_error where a file cannot be read as a table, with the way
// out. `names` are those of the columns where the file has none.
CampaignDraft draft_campaign(const std::vector<std::filesystem::path>& files,
                             std::optional<CampaignPlant> plant, const std::filesystem::path& folder,
                             const std::vector<std::string>& names = {});

// Every key of the plant's nominal.toml; those without which nothing can be said are stated, the rest are
// remarks.
std::string draft_nominal(CampaignPlant plant);

}  // namespace sandhopper
