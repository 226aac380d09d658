#pragma once
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// The plant cannot be guessed from the names and units of the columns.
struct PlantNotTold : std::runtime_error {
  PlantNotTold(const std::string& what, std::vector<std::string> columns)
      : std::runtime_error(what), seen(std::move(columns)) {}
  std::vector<std::string> seen;  // the columns as they were read, and the needs of each plant
};

// Draft of a campaign for files of another program, to be corrected by the user.
struct CampaignDraft {
  CampaignPlant plant{};
  std::vector<std::string> said{};   // interpretation of the files, as sentences
  std::vector<std::string> wrong{};  // reasons why the interpretation cannot be right, as sentences
  std::string campaign_toml{};
  std::string nominal_toml{};
};

// Drafts a campaign from the first file: its format (csv_layout.hpp), its time column, and the channel of
// each column by unit and name. The plant is guessed if `plant` is empty. Both texts contain every key with
// unit and comment; keys of optional physics are commented out. File names are relative to `folder`. `names`:
// names of the columns if the file has none. Throws std::runtime_error with a cure if a file is not a table.
CampaignDraft draft_campaign(const std::vector<std::filesystem::path>& files,
                             std::optional<CampaignPlant> plant, const std::filesystem::path& folder,
                             const std::vector<std::string>& names = {});

// nominal.toml of a plant with every key. Needed keys have the value "?"; all others are commented out.
// `commands_recorded`: the torques that the controller commands are a channel, so its gains are not needed.
std::string draft_nominal(CampaignPlant plant, bool commands_recorded = false);

}  // namespace sandhopper
