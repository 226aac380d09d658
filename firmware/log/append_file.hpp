#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "firmware/log/file_calls.hpp"

namespace sandhopper {

// A new file that grows only by whole pieces: either all data of an append() is in the file or none of it. If
// the file system can, it keeps `reserve_bytes` allocated behind the end. So on a full disk there is room to
// note what was lost and to close. Refuses to overwrite. Throws std::system_error with the file's name and
// what to do. After a failed append the next one may succeed, once there is room. An empty name means that
// the log is switched off: data is accepted and discarded.
class AppendFile {
 public:
  explicit AppendFile(const std::filesystem::path& file, std::uint64_t reserve_bytes = 0,
                      FileCalls calls = FileCalls::of_the_system());
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  const std::filesystem::path& path() const { return file_; }
  void append(std::span<const std::byte> data);
  // From now on append() may use the reserve.
  void open_reserve() noexcept { reserve_bytes_ = 0; }
  // fdatasync(2). Returns 0, or errno if written data may not be on the disk. A file system that cannot sync
  // (a pipe, some network mounts) is no error.
  [[nodiscard]] int sync() noexcept;
  void close();

 private:
  [[noreturn]] void fail(int error, const char* what) const;
  int make_room(std::uint64_t bytes) noexcept;
  void take_back() noexcept;

  std::filesystem::path file_;
  std::uint64_t reserve_bytes_;
  FileCalls calls_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t allocated_ = 0;
  bool can_allocate_ = true;
  bool is_off_ = false;
};

}  // namespace sandhopper
