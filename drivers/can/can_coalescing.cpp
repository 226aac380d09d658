#include "drivers/can/can_coalescing.hpp"

#include <linux/ethtool.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cstring>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

std::optional<CanCoalescing> can_coalescing(const std::string& interface) {
  ifreq request{};
  if (interface.size() >= sizeof request.ifr_name) return std::nullopt;
  std::memcpy(request.ifr_name, interface.c_str(), interface.size());
  ethtool_coalesce settings{};
  settings.cmd = ETHTOOL_GCOALESCE;
  request.ifr_data = reinterpret_cast<char*>(&settings);
  const UniqueFd fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (!fd || ::ioctl(fd.get(), SIOCETHTOOL, &request) != 0) return std::nullopt;
  return CanCoalescing{.receive = {settings.rx_coalesce_usecs_irq, settings.rx_max_coalesced_frames_irq},
                       .transmit = {settings.tx_coalesce_usecs_irq, settings.tx_max_coalesced_frames_irq}};
}

}  // namespace sandhopper
