#pragma once
#include <cstdint>

namespace sandhopper {

// Counts calls of malloc and related functions on this thread during its lifetime.
class AllocationGuard {
 public:
  AllocationGuard();
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;
  std::uint64_t count() const;
};

}  // namespace sandhopper
