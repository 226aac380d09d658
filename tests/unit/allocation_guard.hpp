#pragma once
#include <cstdint>

namespace sandhopper {

// Counts calls of malloc and its relatives, whoever makes them, on this thread while one exists.
class AllocationGuard {
 public:
  AllocationGuard();
  ~AllocationGuard();
  AllocationGuard(const AllocationGuard&) = delete;
  AllocationGuard& operator=(const AllocationGuard&) = delete;
  std::uint64_t count() const;
};

}  // namespace sandhopper
