#include "firmware/refusal_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "firmware/drive_confirmation.hpp"

namespace sandhopper {

std::string refusal_text(const Event& event) {
  if (event.kind != EventKind::arming_refused || event.reason != Reason::drives_not_confirmed) return {};
  constexpr std::array kNames{"left", "right"};
  const double commanded_Nm = event.values[2];
  std::string motors;
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const double measured_Nm = std::abs(event.values[i]) < 0.005 ? 0.0 : event.values[i];  // avoids "-0.00"
                                                                                           // in the text
    if (std::isnan(measured_Nm) || torque_follows(measured_Nm, commanded_Nm)) continue;
    motors += fmt::format("{}{} motor: {:.2f} N m commanded, {:.2f} N m measured", motors.empty() ? "" : "; ",
                          kNames[i], commanded_Nm, measured_Nm);
  }
  return fmt::format(
      "{}, after {:.0f} tries. The drive is not in motor mode, or its current is not what it reports. Let "
      "the "
      "leg hang still, check the motor's phases, its torque constants and the CAN wiring, power-cycle the "
      "drive, then arm again",
      motors, event.values[3]);
}

}  // namespace sandhopper
