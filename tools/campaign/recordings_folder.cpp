#include "tools/campaign/recordings_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <vector>

namespace sandhopper {

namespace fs = std::filesystem;

std::optional<fs::path> recordings_folder(const fs::path& campaign_folder, std::string_view name) {
  std::vector<fs::path> places{campaign_folder / name};
  if (const char* root = std::getenv("SANDHOPPER_DATA"); root != nullptr && *root != '\0')
    places.push_back(fs::path(root) / name);
  std::error_code error;
  fs::path above = fs::absolute(campaign_folder, error).lexically_normal();
  while (!error && above.has_relative_path()) {
    above = above.parent_path();
    places.push_back(above / "shared/data" / name);
  }
  for (const auto& place : places)
    if (fs::is_directory(place, error)) return place;
  return std::nullopt;
}

std::string how_to_get_recordings(std::string_view name, std::string_view source) {
  return fmt::format(
      "the recordings of this campaign are not on this computer. {}{}Put them into a folder '{}' and set "
      "SANDHOPPER_DATA "
      "to the folder that holds it, or write its path as 'data' in campaign.toml",
      source, source.empty() || source.ends_with('.') ? " " : ". ", name);
}

}  // namespace sandhopper
