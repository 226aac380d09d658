#include "tools/faults/sensor_faults.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr double kImuRange_mps2 = 156.9;
constexpr double kGyroRange_radps = 34.9;
constexpr double kLoadCellRange_N = 409.6;

double anywhere(Random& random, double range) { return range * (2.0 * random.uniform() - 1.0); }

}  // namespace

template <>
SensorDefect defect_of<ImuSample>() {
  return {.slow_period_ns = 15 * kMillisecond_ns, .delay_ns = 15 * kMillisecond_ns, .keep_one_in = 3};
}
template <>
SensorDefect defect_of<TofSample>() {
  return {.slow_period_ns = 150 * kMillisecond_ns, .delay_ns = 130 * kMillisecond_ns, .keep_one_in = 4};
}
template <>
SensorDefect defect_of<LoadCellSample>() {
  return {.slow_period_ns = 70 * kMillisecond_ns, .delay_ns = 70 * kMillisecond_ns, .keep_one_in = 3};
}

void spoil(ImuSample& s, Kind kind, Random& random) {
  switch (kind) {
    case Kind::garbage:
      for (auto& a : s.accel_mps2) a = anywhere(random, kImuRange_mps2);
      for (auto& w : s.gyro_radps) w = anywhere(random, kGyroRange_radps);
      return;
    case Kind::wrong:
    case Kind::lifted:
      s.accel_mps2[2] += 25.0;
      return;
    case Kind::biased:
      s.accel_mps2[2] += 4.0;
      return;
    case Kind::saturated:
      s.accel_mps2[2] = kImuRange_mps2;
      return;
    case Kind::not_a_number:
      s.accel_mps2[2] = kNotMeasured;
      return;
    case Kind::tilting:
      s.gyro_radps[1] += 3.0;
      return;
    default:
      return;
  }
}

void spoil(TofSample& s, Kind kind, Random& random) {
  if (kind == Kind::garbage) s.height_m = 3.0 * random.uniform();
  if (kind == Kind::wrong) s.height_m += 0.4;
  if (kind == Kind::saturated || kind == Kind::not_a_number) {
    s.height_m = kNotMeasured;
    s.status = -6;
  }
}

void spoil(LoadCellSample& s, Kind kind, Random& random) {
  if (kind == Kind::garbage) s.force_N = anywhere(random, kLoadCellRange_N);
  if (kind == Kind::wrong) s.force_N += 120.0;
  if (kind == Kind::saturated) s.force_N = kLoadCellRange_N;
  if (kind == Kind::not_a_number) s.force_N = kNotMeasured;
}

}  // namespace sandhopper::faults
