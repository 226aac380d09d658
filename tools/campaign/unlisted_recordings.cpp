#include "tools/campaign/unlisted_recordings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "firmware/log/csv_import.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;

bool is_read(const Campaign& campaign, const std::string& name) {
  return find_channel(campaign.plant, name) != nullptr ||
         std::ranges::any_of(campaign.trials, [&](const CampaignTrial& trial) {
           return std::ranges::any_of(trial.columns, [&](const ColumnMapping& mapping) {
             return mapping.channel != "t_s" && mapping.column == name;
           });
         });
}

bool is_recording(const Campaign& campaign, const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return false;
  const auto table =
      read_csv(in, {.time_column = "", .list_repeats = false, .format = campaign.trials.front().format});
  return table.rows() > 0 &&
         std::ranges::any_of(table.names, [&](const auto& name) { return is_read(campaign, name); });
}

}  // namespace

std::vector<Finding> unlisted_recordings(const Campaign& campaign) {
  std::set<fs::path> listed, folders;
  for (const auto& trial : campaign.trials) {
    listed.insert(trial.file);
    folders.insert(trial.file.parent_path());
    for (const auto& companion : trial.companions) listed.insert(companion.file);
  }
  std::set<std::string> unlisted;
  for (const auto& folder : folders) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
      const auto file = entry.path().lexically_normal();
      const bool is_table = file.extension() == ".csv" || file.extension() == ".txt";
      if (is_table && !listed.contains(file) && is_recording(campaign, file))
        unlisted.insert(file.filename().string());
    }
  }
  if (unlisted.empty()) return {};
  return {{FindingKind::set_up, FindingSeverity::note, campaign.file.string(), 0, 0, "trial",
           fmt::format("no trial lists {}, which {} beside the recordings", fmt::join(unlisted, ", "),
                       unlisted.size() == 1 ? "lies" : "lie"),
           "add a [[trial]] with file = \"…\" for each, or leave it as it is"}};
}

}  // namespace sandhopper
