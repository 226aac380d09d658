#pragma once
#include <sys/mman.h>

#include <cerrno>
#include <new>
#include <system_error>
#include <type_traits>
#include <utility>

namespace sandhopper {

// One object in memory that this process shares with children forked later (anonymous mapping, MAP_SHARED).
// Each side sees what the other writes. Throws std::system_error if there is no memory.
template <class T>
class Shared {
  static_assert(std::is_trivially_destructible_v<T>, "the child ends without destructors");

 public:
  template <class... Args>
  explicit Shared(Args&&... args)
      : memory_(::mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_POPULATE,
                       -1, 0)) {
    if (memory_ == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "shared memory");
    object_ = new (memory_) T(std::forward<Args>(args)...);
  }
  ~Shared() { ::munmap(memory_, sizeof(T)); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  T& operator*() const noexcept { return *object_; }
  T* operator->() const noexcept { return object_; }

 private:
  void* memory_;
  T* object_;
};

}  // namespace sandhopper
