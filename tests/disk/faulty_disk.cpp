// A disk that is slow, small, or turns read-only: a FUSE file system of one folder that keeps its files in
// another.
//   faulty_disk BACKING MOUNT_POINT [--capacity-bytes=N] [--write-delay-ms=N] [--sync-delay-ms=N]
//               [--read-only-after-bytes=N]
// Stays in the foreground until it is unmounted or ended by a signal.
#define FUSE_USE_VERSION 35
#include <dirent.h>
#include <fcntl.h>
#include <fuse.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace {

struct Disk {
  std::string backing;
  std::int64_t capacity_bytes = INT64_MAX;
  std::int64_t read_only_after_bytes = INT64_MAX;
  int write_delay_ms = 0;
  int sync_delay_ms = 0;

  std::mutex mutex;
  std::map<std::string, std::int64_t> taken_bytes;  // of each file, including space allocated beyond its end
  std::int64_t written_bytes = 0;

  std::string place(const char* path) const { return backing + path; }

  // Returns 0 or the errno with which the file may not grow to `end`.
  int take(const char* path, std::int64_t end) {
    const std::lock_guard lock(mutex);
    std::int64_t all = 0;
    for (const auto& [name, bytes] : taken_bytes) all += bytes;
    auto& mine = taken_bytes[path];
    if (end > mine && all - mine + end > capacity_bytes) return -ENOSPC;
    mine = std::max(mine, end);
    return 0;
  }
};

Disk& disk() { return *static_cast<Disk*>(fuse_get_context()->private_data); }
int answer(int result) { return result < 0 ? -errno : 0; }
int descriptor(const fuse_file_info* info) { return static_cast<int>(info->fh); }
void wait_ms(int time) { std::this_thread::sleep_for(std::chrono::milliseconds(time)); }

int get_attributes(const char* path, struct stat* status, fuse_file_info*) {
  return answer(::lstat(disk().place(path).c_str(), status));
}

int read_folder(const char* path, void* buffer, fuse_fill_dir_t fill, off_t, fuse_file_info*,
                fuse_readdir_flags) {
  DIR* folder = ::opendir(disk().place(path).c_str());
  if (folder == nullptr) return -errno;
  while (const dirent* entry = ::readdir(folder))
    fill(buffer, entry->d_name, nullptr, 0, fuse_fill_dir_flags{});
  ::closedir(folder);
  return 0;
}

int open_file(const char* path, fuse_file_info* info) {
  const int file = ::open(disk().place(path).c_str(), info->flags);
  if (file < 0) return -errno;
  info->fh = static_cast<std::uint64_t>(file);
  return 0;
}

int create_file(const char* path, mode_t mode, fuse_file_info* info) {
  const int file = ::open(disk().place(path).c_str(), info->flags | O_CREAT, mode);
  if (file < 0) return -errno;
  info->fh = static_cast<std::uint64_t>(file);
  return 0;
}

int read_file(const char*, char* data, std::size_t size, off_t offset, fuse_file_info* info) {
  const auto got = ::pread(descriptor(info), data, size, offset);
  return got < 0 ? -errno : static_cast<int>(got);
}

int write_file(const char* path, const char* data, std::size_t size, off_t offset, fuse_file_info* info) {
  wait_ms(disk().write_delay_ms);
  disk().written_bytes += static_cast<std::int64_t>(size);
  if (disk().written_bytes > disk().read_only_after_bytes) return -EROFS;
  if (const int error = disk().take(path, offset + static_cast<off_t>(size)); error != 0) return error;
  const auto written = ::pwrite(descriptor(info), data, size, offset);
  return written < 0 ? -errno : static_cast<int>(written);
}

int allocate(const char* path, int mode, off_t offset, off_t length, fuse_file_info* info) {
  if (const int error = disk().take(path, offset + length); error != 0) return error;
  return answer(::fallocate(descriptor(info), mode, offset, length));
}

int truncate_file(const char* path, off_t size, fuse_file_info* info) {
  const int result =
      info != nullptr ? ::ftruncate(descriptor(info), size) : ::truncate(disk().place(path).c_str(), size);
  if (result != 0) return -errno;
  const std::lock_guard lock(disk().mutex);
  disk().taken_bytes[path] = size;
  return 0;
}

int sync_file(const char*, int, fuse_file_info* info) {
  wait_ms(disk().sync_delay_ms);
  return answer(::fdatasync(descriptor(info)));
}

int release_file(const char*, fuse_file_info* info) { return answer(::close(descriptor(info))); }
int remove_file(const char* path) { return answer(::unlink(disk().place(path).c_str())); }

fuse_operations operations() {
  fuse_operations calls{};
  calls.getattr = get_attributes;
  calls.readdir = read_folder;
  calls.open = open_file;
  calls.create = create_file;
  calls.read = read_file;
  calls.write = write_file;
  calls.fallocate = allocate;
  calls.truncate = truncate_file;
  calls.fsync = sync_file;
  calls.release = release_file;
  calls.unlink = remove_file;
  return calls;
}

bool take_option(Disk& disk, std::string_view argument) {
  const auto value = [&](std::string_view name) { return std::atoll(argument.data() + name.size()); };
  for (const std::string_view name :
       {"--capacity-bytes=", "--read-only-after-bytes=", "--write-delay-ms=", "--sync-delay-ms="}) {
    if (!argument.starts_with(name)) continue;
    if (name[2] == 'c') disk.capacity_bytes = value(name);
    if (name[2] == 'r') disk.read_only_after_bytes = value(name);
    if (name[2] == 'w') disk.write_delay_ms = static_cast<int>(value(name));
    if (name[2] == 's') disk.sync_delay_ms = static_cast<int>(value(name));
    return true;
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  static Disk disk;
  if (argc < 3) return 2;
  disk.backing = argv[1];
  for (int i = 3; i < argc; ++i)
    if (!take_option(disk, argv[i])) return 2;
  std::vector<std::string> words{argv[0], "-f", argv[2]};
  std::vector<char*> pointers;
  for (auto& word : words) pointers.push_back(word.data());
  const fuse_operations calls = operations();
  return fuse_main(static_cast<int>(pointers.size()), pointers.data(), &calls, &disk);
}
