#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Folders and file names of freeze frames.
namespace sandhopper::freeze {

inline constexpr std::string_view kFrameEnding = ".freeze.mcap";
inline constexpr std::string_view kMemoryEnding = ".freeze.memory";  // a ring in shared memory
inline constexpr std::string_view kDumpEnding = ".freeze.dump";      // the guard's copy of a ring
inline constexpr std::string_view kServiceFolder = "/var/log/sandhopper/freeze";

// The folder of the frames. `configured` is log.freeze_folder; where that is empty, $LOGS_DIRECTORY/freeze
// (the service), otherwise $XDG_STATE_HOME/sandhopper/freeze, which is ~/.local/state/sandhopper/freeze by
// default.
std::filesystem::path frame_folder(const std::string& configured);

// Folders in memory, best first: $SANDHOPPER_FREEZE_MEMORY where it is set, and no other then;
// /run/sandhopper/freeze (the service's), $XDG_RUNTIME_DIR/sandhopper, /dev/shm/sandhopper-UID.
std::vector<std::filesystem::path> memory_folders();
// The first of them in which this process can write; the last two are made. None: there is no such folder.
std::optional<std::filesystem::path> writable_memory_folder();

// All in which a picture of a fault may lie: the configured one, the user's, the service's, those in memory.
std::vector<std::filesystem::path> all_folders(const std::string& configured);

// All files of a folder with this ending, by name, that is, oldest first. Empty where there is no folder.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, std::string_view ending);

// "2026-11-27_03-03-51.123_trial_001_bus_off": UTC time, stem of the log, what happened. Sorts by time.
std::string frame_name(std::int64_t realtime_ns, const std::filesystem::path& log_file,
                       std::string_view what);

// Removes the oldest frames, with the pages beside them, until `newest` are left.
void keep_newest(const std::filesystem::path& folder, std::size_t newest);

// A process still writes this ring.
bool is_in_use(const std::filesystem::path& memory_file);

}  // namespace sandhopper::freeze
