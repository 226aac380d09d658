#include "firmware/freeze/freeze_folders.hpp"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <system_error>

#include "drivers/clock.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper::freeze {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool is_in_memory(const std::filesystem::path& folder) {
  struct statfs about {};
  return ::statfs(folder.c_str(), &about) == 0 &&
         (about.f_type == TMPFS_MAGIC || about.f_type == RAMFS_MAGIC);
}

}  // namespace

std::filesystem::path frame_folder(const std::string& configured) {
  if (!configured.empty()) return configured;
  if (const auto logs = environment("LOGS_DIRECTORY"); !logs.empty())
    return std::filesystem::path(logs) / "freeze";
  if (const auto state = environment("XDG_STATE_HOME"); !state.empty())
    return std::filesystem::path(state) / "sandhopper/freeze";
  if (const auto home = environment("HOME"); !home.empty())
    return std::filesystem::path(home) / ".local/state/sandhopper/freeze";
  return fmt::format("/var/tmp/sandhopper-{}/freeze", ::getuid());
}

std::vector<std::filesystem::path> memory_folders() {
  if (const auto given = environment("SANDHOPPER_FREEZE_MEMORY"); !given.empty()) return {given};
  std::vector<std::filesystem::path> folders{"/run/sandhopper/freeze"};
  if (const auto run = environment("XDG_RUNTIME_DIR"); !run.empty())
    folders.push_back(std::filesystem::path(run) / "sandhopper");
  folders.emplace_back(fmt::format("/dev/shm/sandhopper-{}", ::getuid()));
  return folders;
}

std::optional<std::filesystem::path> writable_memory_folder() {
  const auto folders = memory_folders();
  const bool is_given = folders.size() == 1;
  for (const auto& folder : folders) {
    if (is_given || folder != folders.front()) ::mkdir(folder.c_str(), 0700);
    if (::access(folder.c_str(), W_OK | X_OK) == 0 && (is_given || is_in_memory(folder))) return folder;
  }
  return std::nullopt;
}

std::vector<std::filesystem::path> all_folders(const std::string& configured) {
  std::vector<std::filesystem::path> folders{frame_folder(""), kServiceFolder};
  if (!configured.empty()) folders.insert(folders.begin(), configured);
  for (auto& folder : memory_folders()) folders.push_back(std::move(folder));
  return folders;
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, std::string_view ending) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const auto name = entry.path().filename().string();
    if (name.ends_with(ending) && !name.starts_with('.')) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::string frame_name(std::int64_t realtime_ns, const std::filesystem::path& log_file,
                       std::string_view what) {
  const auto seconds = static_cast<std::time_t>(realtime_ns / kNanosecondsPerSecond);
  const auto milliseconds = realtime_ns % kNanosecondsPerSecond / 1'000'000;
  const auto trial = log_file.empty() ? std::string("no_log") : log_file.stem().string();
  return fmt::format("{:%Y-%m-%d_%H-%M-%S}.{:03}_{}_{}", fmt::gmtime(seconds), milliseconds, trial, what);
}

void keep_newest(const std::filesystem::path& folder, std::size_t newest) {
  const auto frames = files_in(folder, kFrameEnding);
  std::error_code ignored;
  for (std::size_t i = 0; i + newest < frames.size(); ++i) {
    std::filesystem::remove(frames[i], ignored);
    std::filesystem::remove(std::filesystem::path(frames[i]).replace_extension(".html"), ignored);
  }
}

bool is_in_use(const std::filesystem::path& memory_file) {
  const UniqueFd file(::open(memory_file.c_str(), O_RDONLY | O_CLOEXEC));
  return file && ::flock(file.get(), LOCK_SH | LOCK_NB) != 0;
}

}  // namespace sandhopper::freeze
