#include "firmware/supervision/sensor_check.hpp"

#include <algorithm>

namespace sandhopper {
namespace {

constexpr double kCycles_per_s = 1000.0;
constexpr double kWrongTimes = 2.0;

}  // namespace

void SensorCheck::see(const Seen& seen, Findings& findings) noexcept {
  const double age_s = static_cast<double>(seen.now_ns - seen.time_ns) * 1e-9;
  // Wait for the first sample that is in time: earlier ones were queued while the devices were opened.
  if (last_time_ns_ == 0 && seen.starting && (!seen.fresh || age_s > limits_.age_s)) return;
  findings.add_if(age_s > limits_.age_s, faults_.stale, faults_.number, age_s);
  share_.see(seen.fresh);
  const double rate_Hz = share_.share() * kCycles_per_s;
  findings.add_if(seen.fresh && rate_Hz < limits_.rate_Hz, Fault::sensor_intermittent, faults_.number,
                  rate_Hz);
  if (!seen.fresh) return;

  const bool time_wrong = seen.time_ns <= last_time_ns_ || seen.time_ns > seen.now_ns + kFuture_ns;
  const double ahead_s = static_cast<double>(seen.time_ns - last_time_ns_) * 1e-9;
  findings.add_if(wrong_time_.see(time_wrong) >= kWrongTimes, Fault::sample_time_invalid, faults_.number,
                  ahead_s);
  if (seen.changed && seen.learning) changes_ = std::min(changes_ + 1, kNoisy);
  same_ = seen.changed ? 0 : std::min(same_ + 1, limits_.stuck_samples);
  findings.add_if(changes_ >= kNoisy && same_ >= limits_.stuck_samples, faults_.stuck, faults_.number, same_);
  const double out = out_of_range_.see(!seen.in_range);
  findings.add_if(out >= limits_.range_samples, faults_.out_of_range, faults_.number, out);
  last_time_ns_ = seen.time_ns;
}

}  // namespace sandhopper
