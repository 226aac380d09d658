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

// Folder of the freeze frames. `configured` is log.freeze_folder. If it is empty: $LOGS_DIRECTORY/freeze (the
// service), otherwise $XDG_STATE_HOME/sandhopper/freeze, by default ~/.local/state/sandhopper/freeze.
std::filesystem::path frame_folder(const std::string& configured);

// Folders in memory, best first. If $SANDHOPPER_FREEZE_MEMORY is set it is the only one. Otherwise
// /run/sandhopper/freeze (of the service), $XDG_RUNTIME_DIR/sandhopper, /dev/shm/sandhopper-UID.
std::vector<std::filesystem::path> memory_folders();
// First of these in which this process can write; the last two are created. Empty if there is none.
std::optional<std::filesystem::path> writable_memory_folder();

// All folders that may contain a freeze frame: the configured one, the user's, the service's, those in
// memory.
std::vector<std::filesystem::path> all_folders(const std::string& configured);

// All files of a folder with this ending, by name, i.e. oldest first. Empty if there is no folder.
std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, std::string_view ending);

// "2026-11-27_03-03-51.123_trial_001_bus_off": UTC time, stem of the log, fault or cause. Sorts by time.
std::string frame_name(std::int64_t realtime_ns, const std::filesystem::path& log_file,
                       std::string_view what);

// Removes the oldest frames, with the pages next to them, until `newest` are left.
void keep_newest(const std::filesystem::path& folder, std::size_t newest);

// True if a process still writes this ring.
bool is_in_use(const std::filesystem::path& memory_file);

}  // namespace sandhopper::freeze
