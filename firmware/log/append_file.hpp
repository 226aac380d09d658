#pragma once
#include <cstddef>
#include <filesystem>
#include <span>

namespace sandhopper {

// A new file that only grows. Refuses to overwrite. Throws std::system_error, with the file's name and what
// to do. After a failed write the file is closed: what is in it stays, nothing may follow.
class AppendFile {
 public:
  explicit AppendFile(const std::filesystem::path& file);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  void append(std::span<const std::byte> data);
  // fdatasync(2). A file system that cannot (a pipe, some network mounts) is no reason to stop logging.
  void sync() noexcept;
  void close();

 private:
  [[noreturn]] void fail(int error, const char* what) const;

  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace sandhopper
