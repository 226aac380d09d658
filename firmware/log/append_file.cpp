#include "firmware/log/append_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace sandhopper {

AppendFile::AppendFile(const std::filesystem::path& file) : file_(file) {
  descriptor_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (descriptor_ >= 0) return;
  fail(errno, errno == EEXIST ? "will not overwrite a log; remove it or choose another name"
                              : "cannot create the file; does its folder exist and may it be written?");
}

AppendFile::~AppendFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AppendFile::append(std::span<const std::byte> data) {
  while (!data.empty()) {
    const ssize_t written = ::write(descriptor_, data.data(), data.size());
    if (written < 0) {
      const int error = errno;
      if (error == EINTR) continue;
      if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
      fail(error, "cannot write; is the disk full?");
    }
    data = data.subspan(static_cast<std::size_t>(written));
  }
}

void AppendFile::sync() noexcept { ::fdatasync(descriptor_); }

void AppendFile::close() {
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0) fail(errno, "cannot close the file");
}

void AppendFile::fail(int error, const char* what) const {
  throw std::system_error(error, std::generic_category(), file_.string() + ": " + what);
}

}  // namespace sandhopper
