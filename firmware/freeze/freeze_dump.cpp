#include "firmware/freeze/freeze_dump.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "firmware/freeze/freeze_folders.hpp"

namespace sandhopper {

FreezeDump::FreezeDump(FreezeRing& ring, const std::filesystem::path& folder) : ring_(ring) {
  std::filesystem::create_directories(folder);
  const auto& header = ring.header();
  const FreezeReader reader(ring.bytes());
  const auto name = freeze::frame_name(header.start_ns + header.realtime_offset_ns, reader.log_file(),
                                       std::to_string(header.process)) +
                    std::string(freeze::kDumpEnding);
  final_ = folder / name;
  hidden_ = folder / ("." + name);
  file_ = UniqueFd(::open(hidden_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640));
  if (!file_) throw std::system_error(errno, std::generic_category(), hidden_.string());
  if (const int error = ::posix_fallocate(file_.get(), 0, static_cast<off_t>(ring.bytes().size()));
      error != 0) {
    ::unlink(hidden_.c_str());
    throw std::system_error(error, std::generic_category(), hidden_.string());
  }
  descriptor_ = file_.get();
}

void FreezeDump::run() noexcept {
  const std::uint64_t count = ring_.header().count.load(std::memory_order_acquire);
  std::span<const std::byte> rest = ring_.bytes();
  if (::lseek(file_.get(), 0, SEEK_SET) != 0) return;
  while (!rest.empty()) {
    const ssize_t written = ::write(file_.get(), rest.data(), rest.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    rest = rest.subspan(static_cast<std::size_t>(written));
  }
  ::fdatasync(file_.get());
  if (::rename(hidden_.c_str(), final_.c_str()) != 0 && errno != ENOENT) return;
  ring_.header().dumped_at.store(count, std::memory_order_release);
}

void FreezeDump::take_back() noexcept {
  if (ring_.header().dumped_at.exchange(0, std::memory_order_acq_rel) != 0)
    ::rename(final_.c_str(), hidden_.c_str());
}

void FreezeDump::remove() noexcept {
  ::unlink(hidden_.c_str());
  ::unlink(final_.c_str());
}

}  // namespace sandhopper
