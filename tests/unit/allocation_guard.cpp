#include "tests/unit/allocation_guard.hpp"

#include <cstddef>

namespace {
thread_local bool counting = false;
thread_local std::uint64_t calls = 0;
}  // namespace

// Sanitizers replace malloc. Then the count stays zero, and the test that plants an allocation reports this.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t bytes) {
  if (counting) ++calls;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) {
  if (counting) ++calls;
  return __libc_calloc(count, bytes);
}
void* realloc(void* block, std::size_t bytes) {
  if (counting) ++calls;
  return __libc_realloc(block, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) {
  if (counting) ++calls;
  return __libc_memalign(alignment, bytes);
}
}
#endif

namespace sandhopper {

AllocationGuard::AllocationGuard() {
  calls = 0;
  counting = true;
}
AllocationGuard::~AllocationGuard() { counting = false; }
std::uint64_t AllocationGuard::count() const { return calls; }

}  // namespace sandhopper
