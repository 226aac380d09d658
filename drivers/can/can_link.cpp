#include "drivers/can/can_link.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/socket.h>

#include <array>
#include <cstring>
#include <span>

#include "drivers/device_error.hpp"
#include "drivers/unique_fd.hpp"

namespace sandhopper {
namespace {

using Bytes = std::span<const std::byte>;

template <class T>
std::optional<T> value_of(Bytes bytes) {
  T value;
  if (bytes.size() < sizeof value) return std::nullopt;
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

// Calls visit(type, payload) for each attribute in a sequence of netlink attributes.
template <class Visit>
void each_attribute(Bytes bytes, Visit&& visit) {
  while (const auto header = value_of<rtattr>(bytes)) {
    if (header->rta_len < sizeof(rtattr) || header->rta_len > bytes.size()) return;
    visit(header->rta_type & NLA_TYPE_MASK, bytes.subspan(sizeof(rtattr), header->rta_len - sizeof(rtattr)));
    const std::size_t step = RTA_ALIGN(header->rta_len);
    if (step >= bytes.size()) return;
    bytes = bytes.subspan(step);
  }
}

std::optional<BusState> bus_state(std::uint32_t state) {
  switch (state) {
    case CAN_STATE_ERROR_ACTIVE:
      return BusState::active;
    case CAN_STATE_ERROR_WARNING:
      return BusState::warning;
    case CAN_STATE_ERROR_PASSIVE:
      return BusState::passive;
    case CAN_STATE_BUS_OFF:
      return BusState::off;
    default:
      return std::nullopt;
  }
}

void read_controller(Bytes data, CanLink& link) {
  each_attribute(data, [&](int type, Bytes payload) {
    if (type == IFLA_CAN_BITTIMING) {
      if (const auto timing = value_of<can_bittiming>(payload)) link.bitrate = timing->bitrate;
    } else if (type == IFLA_CAN_STATE) {
      if (const auto state = value_of<std::uint32_t>(payload)) link.state = bus_state(*state);
    } else if (type == IFLA_CAN_RESTART_MS) {
      link.restart_ms = value_of<std::uint32_t>(payload);
    } else if (type == IFLA_CAN_BERR_COUNTER) {
      if (const auto c = value_of<can_berr_counter>(payload)) link.errors = {c->txerr, c->rxerr};
    }
  });
}

CanLink read_link(const ifinfomsg& info, Bytes attributes) {
  CanLink link;
  link.up = (info.ifi_flags & IFF_UP) != 0;
  each_attribute(attributes, [&](int type, Bytes payload) {
    if (type == IFLA_TXQLEN) link.queue_length = value_of<std::uint32_t>(payload).value_or(0);
    if (type != IFLA_LINKINFO) return;
    each_attribute(payload, [&](int inner, Bytes data) {
      if (inner == IFLA_INFO_DATA) read_controller(data, link);
    });
  });
  return link;
}

struct Request {
  nlmsghdr header;
  ifinfomsg link;
};

std::size_t ask(int fd, int index, std::span<std::byte> answer) {
  Request request{};
  request.header.nlmsg_len = sizeof request;
  request.header.nlmsg_type = RTM_GETLINK;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.link.ifi_family = AF_UNSPEC;
  request.link.ifi_index = index;
  if (::send(fd, &request, sizeof request, 0) < 0) return 0;
  const auto count = ::recv(fd, answer.data(), answer.size(), 0);
  return count < 0 ? 0 : static_cast<std::size_t>(count);
}

}  // namespace

std::optional<CanLink> can_link(const std::string& interface) {
  const auto index = ::if_nametoindex(interface.c_str());
  if (index == 0) return std::nullopt;
  const UniqueFd fd(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE));
  std::array<std::byte, 16384> buffer{};
  const auto count = fd ? ask(fd.get(), static_cast<int>(index), buffer) : 0;
  const auto answer = Bytes(buffer).first(count);
  const auto header = value_of<nlmsghdr>(answer);
  if (!header || header->nlmsg_type != RTM_NEWLINK || header->nlmsg_len > count)
    throw DeviceError("can (" + interface + ")", errno_cause("the kernel does not say what it is"),
                      "allow AF_NETLINK sockets, or look with: ip -details link show " + interface);
  const auto body = answer.subspan(NLMSG_HDRLEN, header->nlmsg_len - NLMSG_HDRLEN);
  const auto info = value_of<ifinfomsg>(body);
  if (!info || info->ifi_type != ARPHRD_CAN) return std::nullopt;
  return read_link(*info, body.subspan(NLMSG_ALIGN(sizeof(ifinfomsg))));
}

}  // namespace sandhopper
