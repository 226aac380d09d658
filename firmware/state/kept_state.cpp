#include "firmware/state/kept_state.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <system_error>

#include "config/dump.hpp"
#include "config/load.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kFormat = "sandhopper-state 1";
constexpr std::size_t kLongest = 65536;  // larger files are not read

std::string header(std::string_view body) {
  const auto crc = ::crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return fmt::format("{} {} {:08x}\n", kFormat, body.size(), crc);
}

StateRead unreadable(std::string problem) { return {std::nullopt, true, std::move(problem)}; }

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

void write_all(int fd, std::string_view text, const std::string& name) {
  while (!text.empty()) {
    const auto count = ::write(fd, text.data(), text.size());
    if (count < 0 && errno != EINTR) fail("cannot write " + name);
    if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace

std::string state_text(const KeptState& state) {
  const auto body = to_toml(to_node(state));
  return header(body) + body;
}

StateRead state_from_text(std::string_view text) {
  const auto end = text.find('\n');
  if (end == std::string_view::npos || !text.starts_with(std::string(kFormat) + " "))
    return unreadable("it is no state of this version");
  const auto body = text.substr(end + 1);
  if (text.substr(0, end + 1) != header(body)) return unreadable("its length or checksum is wrong");
  try {
    return {load_text<KeptState>("state", body), true, ""};
  } catch (const ConfigError& error) {
    return unreadable(error.what());
  }
}

StateRead read_state_file(const std::filesystem::path& file) {
  const UniqueFd fd(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!fd) {
    const int error = errno;
    return {std::nullopt, error != ENOENT && error != ENOTDIR, std::generic_category().message(error)};
  }
  std::string text(kLongest + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const auto got = ::read(fd.get(), text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return unreadable(std::generic_category().message(errno));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  if (size > kLongest) return unreadable("it is too long to be a state");
  text.resize(size);
  return state_from_text(text);
}

void write_state_file(const std::filesystem::path& file, const KeptState& state) {
  auto scratch = file;
  scratch += fmt::format(".new{}", ::getpid());  // another hopperd may write at the same time
  {
    const UniqueFd fd(::open(scratch.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0664));
    if (!fd) fail("cannot make " + scratch.string());
    ::fchmod(fd.get(), 0664);  // the service and shells of its group may replace each other's file
    write_all(fd.get(), state_text(state), scratch.string());
    if (::fsync(fd.get()) != 0) fail("cannot write " + scratch.string());
  }
  if (std::rename(scratch.c_str(), file.c_str()) != 0) fail("cannot replace " + file.string());
  const UniqueFd folder(::open(file.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder) ::fsync(folder.get());
}

StatePlaces state_places(const std::string& directory) {
  const auto folder = [&](const char* variable, const char* otherwise) -> std::filesystem::path {
    if (!directory.empty()) return directory;
    const char* set = std::getenv(variable);
    return set != nullptr && *set != '\0' ? set : otherwise;
  };
  return {folder("RUNTIME_DIRECTORY", "/run/sandhopper") / "boot.state",
          folder("STATE_DIRECTORY", "/var/lib/sandhopper") / "lasting.state"};
}

}  // namespace sandhopper
