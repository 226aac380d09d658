#include "tools/trial/live/daemon_link.hpp"

#include <poll.h>

namespace sandhopper {

bool DaemonLink::take(std::vector<std::string>& lines) {
  bool open = true;
  for (pollfd ready{daemon_.output(), POLLIN, 0}; open && ::poll(&ready, 1, 0) > 0;)
    open = daemon_.read_some(partial_);
  for (auto end = partial_.find('\n'); end != std::string::npos; end = partial_.find('\n')) {
    lines.push_back(partial_.substr(0, end));
    partial_.erase(0, end + 1);
  }
  return open;
}

}  // namespace sandhopper
