#pragma once
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <memory>
#include <thread>

#include "firmware/log/file_calls.hpp"

namespace sandhopper {

// A disk with limited space that can fail or be slow. Allocated space counts as used, as in a file system.
// Only one file is written to it.
class FailingDisk {
 public:
  std::atomic<std::int64_t> capacity_bytes{INT64_MAX};
  std::atomic<int> write_error{0};  // errno of every write; 0: no error
  std::atomic<int> sync_error{0};
  std::atomic<std::int64_t> delay_us{0};  // of each write
  std::atomic<bool> can_allocate{true};

  FileCalls calls() {
    return {.write =
                [this](int descriptor, std::span<const std::byte> data) {
                  if (delay_us > 0) std::this_thread::sleep_for(std::chrono::microseconds(delay_us.load()));
                  if (write_error != 0) return fail(write_error);
                  const auto at = ::lseek(descriptor, 0, SEEK_CUR);
                  const auto end = at + static_cast<off_t>(data.size());
                  const auto room = std::max(allocated_, capacity_bytes.load()) - at;
                  if (end > allocated_ && end > capacity_bytes && room <= 0) return fail(ENOSPC);
                  return ::write(descriptor, data.data(),
                                 std::min(data.size(), static_cast<std::size_t>(room)));
                },
            .allocate = [this](int, off_t start, off_t length) -> int {
              if (!can_allocate) return static_cast<int>(fail(EOPNOTSUPP));
              if (start + length > capacity_bytes) return static_cast<int>(fail(ENOSPC));
              allocated_ = start + length;
              return 0;
            },
            .sync = [this](int) -> int { return sync_error == 0 ? 0 : static_cast<int>(fail(sync_error)); }};
  }

 private:
  static ssize_t fail(int error) {
    errno = error;
    return -1;
  }
  std::int64_t allocated_ = 0;
};

}  // namespace sandhopper
