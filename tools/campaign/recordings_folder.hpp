#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// Recordings that are kept apart from their campaign.toml, because they are not the project's to hand on. The
// campaign names their folder (`data`) and says how to get them (`source`).
namespace sandhopper {

// The folder `name`: relative to `campaign_folder`, in $SANDHOPPER_DATA, or in a folder `shared/data` of a
// folder above the campaign; the first that exists. None: it is not on this computer.
std::optional<std::filesystem::path> recordings_folder(const std::filesystem::path& campaign_folder,
                                                       std::string_view name);

// Message for the user if there is none: how to get the recordings, and the two ways to say where they
// are.
std::string how_to_get_recordings(std::string_view name, std::string_view source);

}  // namespace sandhopper
