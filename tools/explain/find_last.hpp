#pragma once
#include <filesystem>
#include <optional>
#include <vector>

namespace sandhopper {

// The newest picture of a fault in these folders: a freeze frame, the ring of a hopperd that was killed, or
// the guard's dump of one. The ring of a running hopperd is none.
std::optional<std::filesystem::path> find_last_freeze(const std::vector<std::filesystem::path>& folders);

}  // namespace sandhopper
