#include "config/directory.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "config/problem.hpp"

namespace sandhopper {
namespace {

namespace fs = std::filesystem;
constexpr const char* kInstalled = "/etc/sandhopper";

[[noreturn]] void refuse(const std::string& name, const std::string& text) {
  throw ConfigError({{name, {0, 0}, "", text}});
}

fs::path named_directory(const std::string& name, const std::string& said_by) {
  std::error_code error;
  if (fs::exists(fs::path(name) / "robot.toml", error)) return name;
  const auto* const instead = fs::is_directory(name, error) ? "this one has none"
                              : fs::exists(name, error)     ? "this is a file"
                                                            : "this is not there";
  refuse(name, fmt::format("{} must name a directory with robot.toml; {}", said_by, instead));
}

// Shortest form of the path as seen from the current directory.
fs::path as_seen_from_here(const fs::path& path) {
  std::error_code error;
  const auto relative = fs::relative(path, error);
  return error || relative.empty() || *relative.begin() == ".." ? path : relative;
}

}  // namespace

fs::path find_config_directory(const std::string& option) {
  if (!option.empty()) return named_directory(option, "--config");
  if (const char* variable = std::getenv("SANDHOPPER_CONFIG"); variable && *variable)
    return named_directory(variable, "SANDHOPPER_CONFIG");

  std::error_code error;
  const auto program = fs::read_symlink("/proc/self/exe", error);
  for (auto folder = program.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    if (fs::exists(folder / "config" / "robot.toml", error)) return as_seen_from_here(folder / "config");
    if (folder == folder.root_path()) break;
  }
  if (fs::exists(fs::path(kInstalled) / "robot.toml", error)) return kInstalled;
  refuse("config",
         fmt::format("no configuration found above {} or in {}: name its directory with --config DIR or in "
                     "SANDHOPPER_CONFIG",
                     program.parent_path().string(), kInstalled));
}

}  // namespace sandhopper
