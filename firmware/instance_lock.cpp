#include "firmware/instance_lock.hpp"

#include <fmt/format.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>

#include "drivers/device_error.hpp"

namespace sandhopper {
namespace {

// An interface can have several names (ip link property add dev can0 altname leg). All of them have its
// index.
std::string identity(const std::string& interface) {
  const auto index = ::if_nametoindex(interface.c_str());
  return index == 0 ? interface : "#" + std::to_string(index);
}

// Abstract socket address: the name begins with a zero byte and is delimited only by its length.
struct Address {
  explicit Address(const std::string& interface) {
    socket.sun_family = AF_UNIX;
    const auto name = "sandhopper/hopperd/" + identity(interface);
    const auto length = std::min(name.size(), sizeof socket.sun_path - 1);
    std::memcpy(socket.sun_path + 1, name.data(), length);
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&socket); }
  sockaddr_un socket{};
  socklen_t size = 0;
};

UniqueFd stream_socket() {
  return UniqueFd(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

// Process that listens at the address, or 0.
pid_t holder(const Address& address) {
  const auto fd = stream_socket();
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::connect(fd.get(), address.get(), address.size) != 0) return 0;
  return ::getsockopt(fd.get(), SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 ? peer.pid : 0;
}

std::string described(pid_t pid) {
  if (pid == 0) return "another process";
  std::string name;
  std::ifstream comm(fmt::format("/proc/{}/comm", pid));
  std::getline(comm, name);
  return fmt::format("process {}{}", pid, name.empty() ? "" : " (" + name + ")");
}

}  // namespace

InstanceLock::InstanceLock(const std::string& interface) : fd_(stream_socket()) {
  const Address address(interface);
  if (fd_ && ::bind(fd_.get(), address.get(), address.size) == 0 && ::listen(fd_.get(), 4) == 0) return;
  if (errno != EADDRINUSE)
    throw DeviceError("lock of " + interface, errno_cause("no Unix socket"), "Allow AF_UNIX sockets");
  throw DeviceError(
      interface, described(holder(address)) + " already runs the motors of this interface",
      "End it first (`quit`, or SIGTERM), or name another interface in can.interface; nothing was sent");
}

}  // namespace sandhopper
