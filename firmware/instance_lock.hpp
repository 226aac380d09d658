#pragma once
#include <string>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// One hopperd a CAN interface, whichever of its names each uses. The lock is a listening Unix socket with an
// abstract name, so it goes with the process however that ends, needs no folder that every user may write,
// and is seen exactly where the interface is: both belong to the network namespace.
class InstanceLock {
 public:
  // Throws DeviceError, which names the process that holds it.
  explicit InstanceLock(const std::string& interface);

 private:
  UniqueFd fd_;
};

}  // namespace sandhopper
