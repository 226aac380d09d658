#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>

#include <array>
#include <set>

#include "drivers/can/can_coalescing.hpp"
#include "drivers/can/can_link.hpp"
#include "drivers/device_error.hpp"
#include "drivers/unique_fd.hpp"
#include "tools/cli/doctor.hpp"

namespace sandhopper::cli {
namespace {

constexpr std::uint32_t kBitrate = 1'000'000;  // the only one the drives support

bool is_virtual(const CanLink& link) { return !link.bitrate; }

Finding bitrate(const std::string& what, const std::string& name, const CanLink& link) {
  if (is_virtual(link)) return {Health::ok, what, "virtual, without bit timing", ""};
  if (*link.bitrate == kBitrate) return {Health::ok, what, fmt::format("{} bit/s", *link.bitrate), ""};
  return {Health::fail, what,
          *link.bitrate == 0 ? "never set"
                             : fmt::format("{} bit/s, the drives speak {}", *link.bitrate, kBitrate),
          fmt::format("ip link set {0} down; ip link set {0} up type can bitrate {1} restart-ms 0", name,
                      kBitrate)};
}

Finding error_state(const std::string& what, const std::string& name, const CanLink& link) {
  if (is_virtual(link)) return {Health::ok, what, "virtual, without a controller", ""};
  const auto counts = link.errors ? fmt::format(", error counters {} sent, {} received",
                                                link.errors->transmit, link.errors->receive)
                                  : std::string(", error counters not told by this controller's driver");
  const auto found = fmt::format("{}{}", link.state ? name_of(*link.state) : "stopped", counts);
  if (!link.state || *link.state == BusState::off)
    return {Health::fail, what, found,
            fmt::format(
                "switch the motors' power on, check wiring and terminators, then ip link set {0} down; ip "
                "link set {0} up",
                name)};
  if (*link.state == BusState::active &&
      (!link.errors || (link.errors->transmit < 96 && link.errors->receive < 96)))
    return {Health::ok, what, found, ""};
  return {
      Health::warn, what, found,
      "frames are lost: 60 Ohm between CAN_H and CAN_L with the power off? all nodes on and at 1 Mbit/s?"};
}

Finding queue(const std::string& what, const std::string& name, const CanLink& link) {
  const auto found = fmt::format("queue of {} frames", link.queue_length);
  if (is_virtual(link) || link.queue_length <= 32) return {Health::ok, what, found, ""};
  return {Health::warn, what, found + ": old commands may wait in it",
          fmt::format("ip link set {} txqueuelen 4 (drivers/README.md says why)", name)};
}

Finding coalescing(const std::string& what, const std::string& name) {
  const auto settings = can_coalescing(name);
  if (!settings) return {Health::ok, what, "this interface's driver collects no frames", ""};
  const auto text = [](const CanCoalescing::Direction& d) {
    return d.waits() ? fmt::format("up to {} us or {} frames", d.usecs, d.frames) : std::string("at once");
  };
  const auto found = fmt::format("interrupts for received frames {}, for sent frames {}",
                                 text(settings->receive), text(settings->transmit));
  if (!settings->receive.waits() && !settings->transmit.waits()) return {Health::ok, what, found, ""};
  return {
      Health::warn, what, found,
      fmt::format("ip link set {0} down; ethtool -C {0} rx-usecs-irq 0 rx-frames-irq 1; ethtool -C {0} "
                  "tx-usecs-irq 0 tx-frames-irq 1; ip link set {0} up (can-up does this if ethtool is there)",
                  name)};
}

// Names of kernel threads and of /sys contain only the interface's primary name, not an alternative one.
Finding interface_name(const std::string& what, const std::string& name) {
  std::array<char, IF_NAMESIZE> own{};
  ::if_indextoname(::if_nametoindex(name.c_str()), own.data());
  if (name == own.data()) return {Health::ok, what, name, ""};
  return {Health::warn, what, fmt::format("{} is another name of {}", name, own.data()),
          fmt::format("set can.interface = \"{}\" in linux.toml, so that interrupt threads are found by it",
                      own.data())};
}

}  // namespace

std::vector<Finding> examine_bus(const std::string& name) {
  try {
    const auto link = can_link(name);
    if (!link || !link->up) return {};  // reported by examine_devices()
    return {interface_name("can name", name), bitrate("can bit rate", name, *link),
            error_state("can error state", name, *link), queue("can queue", name, *link),
            coalescing("can coalescing", name)};
  } catch (const DeviceError& error) {
    return {{Health::warn, "can bit rate", error.cause(), error.cure()}};
  }
}

struct BusListener::Socket {
  UniqueFd fd;
  bool virtual_bus = false;
};

BusListener::BusListener(const std::string& interface) : socket_(std::make_unique<Socket>()) {
  auto& fd = socket_->fd;
  fd = UniqueFd(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0 || !fd ||
      ::bind(fd.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
    fd = UniqueFd();
  socket_->virtual_bus = interface.starts_with('v');
}

BusListener::~BusListener() = default;

Finding BusListener::seen(const CanConfig& config) {
  std::set<canid_t> ids;
  can_frame frame{};
  iovec part{&frame, sizeof frame};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  while (socket_->fd && ::recvmsg(socket_->fd.get(), &message, MSG_DONTWAIT) == sizeof frame) {
    const bool from_here = (message.msg_flags & MSG_DONTROUTE) != 0;
    if (!from_here || socket_->virtual_bus) ids.insert(frame.can_id & ~CAN_RTR_FLAG);
    message.msg_flags = 0;
  }
  std::string list;
  for (const canid_t id : ids) {
    const bool extended = (id & CAN_EFF_FLAG) != 0;
    list += fmt::format("{}{}", list.empty() ? "" : " ",
                        extended ? fmt::format("{:08X}", id & CAN_EFF_MASK) : fmt::format("{:03X}", id));
  }
  if (!ids.empty())
    return {Health::ok, "can ids seen", list + (socket_->virtual_bus ? ", our own among them" : ""), ""};
  return {Health::fail, "can ids seen",
          fmt::format("none on {} while the drives were asked for their state", config.interface),
          "switch the motors' power on; check CAN_H, CAN_L and the two 120 Ohm terminators"};
}

}  // namespace sandhopper::cli
