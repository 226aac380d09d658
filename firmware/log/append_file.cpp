#include "firmware/log/append_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace sandhopper {
namespace {

// Disk space is allocated in steps of this size, so that the file system is called seldom. close() frees the
// rest.
constexpr std::uint64_t kStep_bytes = 1 << 20;

bool no_room(int error) { return error == ENOSPC || error == EDQUOT; }

}  // namespace

FileCalls FileCalls::of_the_system() {
  return {
      .write = [](int descriptor,
                  std::span<const std::byte> data) { return ::write(descriptor, data.data(), data.size()); },
      .allocate = [](int descriptor, off_t start,
                     off_t length) { return ::fallocate(descriptor, FALLOC_FL_KEEP_SIZE, start, length); },
      .sync = [](int descriptor) { return ::fdatasync(descriptor); }};
}

AppendFile::AppendFile(const std::filesystem::path& file, std::uint64_t reserve_bytes, FileCalls calls)
    : file_(file), reserve_bytes_(reserve_bytes), calls_(std::move(calls)), is_off_(file.empty()) {
  if (is_off_) return;
  descriptor_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor_ >= 0) return;
  fail(errno, errno == EEXIST ? "will not overwrite a log; remove it or choose another name"
                              : "cannot create the file; does its folder exist and may it be written?");
}

AppendFile::~AppendFile() {
  if (descriptor_ < 0) return;
  take_back();
  ::close(descriptor_);
}

void AppendFile::append(std::span<const std::byte> data) {
  if (is_off_) return;
  if (descriptor_ < 0) fail(EBADF, "the file is closed");
  if (const int error = make_room(data.size()); error != 0) fail(error, "cannot write; is the disk full?");
  std::span<const std::byte> rest = data;
  while (!rest.empty()) {
    const ssize_t written = calls_.write(descriptor_, rest);
    if (written < 0) {
      const int error = errno;
      if (error == EINTR) continue;
      take_back();
      fail(error, "cannot write; is the disk full?");
    }
    rest = rest.subspan(static_cast<std::size_t>(written));
  }
  size_ += data.size();
}

// Returns 0, or the errno if there is no room for `bytes` more and the reserve. If the file system cannot
// allocate, write(2) will report the error.
int AppendFile::make_room(std::uint64_t bytes) noexcept {
  const std::uint64_t wanted = size_ + bytes + reserve_bytes_;
  if (!can_allocate_ || wanted <= allocated_) return 0;
  for (const std::uint64_t more : {kStep_bytes, std::uint64_t{0}}) {
    const std::uint64_t end = wanted + more;
    if (calls_.allocate(descriptor_, static_cast<off_t>(size_), static_cast<off_t>(end - size_)) == 0) {
      allocated_ = end;
      return 0;
    }
    if (!no_room(errno)) {
      can_allocate_ = false;
      return 0;
    }
  }
  return ENOSPC;
}

// Truncates to the complete pieces: removes a partly written piece and the space allocated behind the end.
void AppendFile::take_back() noexcept {
  if (::ftruncate(descriptor_, static_cast<off_t>(size_)) == 0) allocated_ = size_;
  ::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET);
}

int AppendFile::sync() noexcept {
  if (descriptor_ < 0 || calls_.sync(descriptor_) == 0) return 0;
  const bool cannot = errno == EINVAL || errno == ENOSYS || errno == EOPNOTSUPP;
  return cannot ? 0 : errno;
}

void AppendFile::close() {
  if (descriptor_ < 0) return;
  take_back();
  if (::close(std::exchange(descriptor_, -1)) != 0) fail(errno, "cannot close the file");
}

void AppendFile::fail(int error, const char* what) const {
  throw std::system_error(error, std::generic_category(), file_.string() + ": " + what);
}

}  // namespace sandhopper
