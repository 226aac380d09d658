#include "tools/campaign/integrated_twice.hpp"

#include <cmath>

namespace sandhopper {

IntegratedTwice integrated_twice(const TrialRecording& recording, std::string_view acceleration,
                                 std::string_view position) {
  const auto a = recording.channel(acceleration), z = recording.channel(position);
  IntegratedTwice out;
  double last_s = NAN, last_mps2 = 0.0, speed_mps = 0.0, way_m = 0.0;
  for (std::size_t row = 0; row < recording.rows(); ++row) {
    if (std::isnan(a[row])) continue;
    const double step_s = std::isnan(last_s) ? 0.0 : recording.t_s[row] - last_s;
    way_m += step_s * (speed_mps + step_s * (last_mps2 / 3.0 + a[row] / 6.0));
    speed_mps += 0.5 * step_s * (last_mps2 + a[row]);
    last_s = recording.t_s[row];
    last_mps2 = a[row];
    if (std::isnan(z[row])) continue;
    out.t_s.push_back(last_s);
    out.position_m.push_back(z[row]);
    out.way_m.push_back(way_m);
  }
  return out;
}

}  // namespace sandhopper
