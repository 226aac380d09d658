#include "tools/report/event_text.hpp"

#include <fmt/format.h>

#include "firmware/fault_check.hpp"
#include "firmware/refusal_text.hpp"

namespace sandhopper {

std::string values_of(const Event& event, const ConfigNode* robot) {
  const auto& v = event.values;
  switch (event.kind) {
    case EventKind::zero_check:
    case EventKind::arming_refused:
      if (event.reason == Reason::drives_not_confirmed) return refusal_text(event);
      return fmt::format("left {:.4f} rad, right {:.4f} rad, expected {:.4f} rad, moved by {:.4f} rad", v[0],
                         v[1], v[2], v[3]);
    case EventKind::released:
      return fmt::format("the body's accelerometer reads {:.2f} m/s², foot at {:.1f} mm, body at {:.1f} mm",
                         v[0], 1e3 * v[1], 1e3 * v[2]);
    case EventKind::touchdown:
    case EventKind::stance_switch:
    case EventKind::liftoff:
      return fmt::format("leg {:.1f} mm changing by {:.3f} m/s, foot at {:.1f} mm moving at {:.3f} m/s",
                         1e3 * v[0], v[1], 1e3 * v[2], v[3]);
    case EventKind::fault_raised:
    case EventKind::disarm_refused:
      return in_words(read_fault(event, robot));
    case EventKind::clock_stepped:
      return fmt::format("the date was set {} by {:.3f} s, or the computer slept",
                         v[0] < 0.0 ? "back" : "forward", v[0] < 0.0 ? -v[0] : v[0]);
    case EventKind::armed:
    case EventKind::stop_requested:
    case EventKind::stopped:
    case EventKind::disarmed:
      return {};
  }
  return {};
}

}  // namespace sandhopper
