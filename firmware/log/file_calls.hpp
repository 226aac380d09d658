#pragma once
#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <span>

namespace sandhopper {

// System calls that write a log. A test replaces them to simulate a full, failing or slow disk. Each returns
// what the call returns, or -1 with errno.
struct FileCalls {
  std::function<ssize_t(int descriptor, std::span<const std::byte> data)> write;
  // fallocate(2) with FALLOC_FL_KEEP_SIZE: reserves `length` bytes from `start`; the file size stays.
  std::function<int(int descriptor, off_t start, off_t length)> allocate;
  std::function<int(int descriptor)> sync;  // fdatasync(2)

  static FileCalls of_the_system();
};

}  // namespace sandhopper
