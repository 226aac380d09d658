#pragma once
#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <span>

namespace sandhopper {

// The system calls a log is written with. A test puts a full, failing or slow disk in their place; each
// answers as the call does, -1 with errno.
struct FileCalls {
  std::function<ssize_t(int descriptor, std::span<const std::byte> data)> write;
  // fallocate(2) with FALLOC_FL_KEEP_SIZE: room for `length` bytes from `start`, the size stays.
  std::function<int(int descriptor, off_t start, off_t length)> allocate;
  std::function<int(int descriptor)> sync;  // fdatasync(2)

  static FileCalls of_the_system();
};

}  // namespace sandhopper
