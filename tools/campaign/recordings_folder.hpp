#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// Recordings that are stored apart from their campaign.toml because the project may not redistribute them.
// The campaign names their folder (`data`) and says how to get them (`source`).
namespace sandhopper {

// Path of the folder `name`. Searched in this order: relative to `campaign_folder`, in $SANDHOPPER_DATA, in a
// folder `shared/data` of a parent folder. Empty if it is not on this computer.
std::optional<std::filesystem::path> recordings_folder(const std::filesystem::path& campaign_folder,
                                                       std::string_view name);

// Message for the user if the folder is missing: how to get the recordings, and two ways to state their
// place.
std::string how_to_get_recordings(std::string_view name, std::string_view source);

}  // namespace sandhopper
