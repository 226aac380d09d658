#pragma once
#include <string>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// Allows one hopperd per CAN interface, under any of the interface's names. The lock is a listening Unix
// socket with an abstract name. So it ends with the process in every case, needs no folder writable by all
// users, and has the interface's scope: both belong to the network namespace.
class InstanceLock {
 public:
  // Throws DeviceError, which names the process that holds the lock.
  explicit InstanceLock(const std::string& interface);

 private:
  UniqueFd fd_;
};

}  // namespace sandhopper
