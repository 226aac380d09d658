#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "config/consistency.hpp"
#include "config/contradiction_list.hpp"

namespace sandhopper {
namespace {

constexpr double kTick_s = 1e-3;  // period of the cycle
constexpr double kStandardGravity_mps2 = 9.80665;
constexpr double kSpiBitsPerSample = 8.0 * 18.0;  // address, burst and the polled status register
constexpr std::array kAdcFullScale_V{6.144, 4.096, 2.048, 1.024, 0.512, 0.256};       // as in AdcRange
constexpr std::array kAdcRate_Hz{8.0, 16.0, 32.0, 64.0, 128.0, 250.0, 475.0, 860.0};  // as in AdcRate

// Smallest range of the three axes after their biases are subtracted.
double carried(double full_scale, const std::array<double, 3>& scale, const std::array<double, 3>& bias) {
  double least = full_scale * scale[0];
  for (std::size_t axis = 0; axis < 3; ++axis)
    least = std::min(least, scale[axis] * (full_scale - std::abs(bias[axis])));
  return least;
}

std::string range_that_carries(double needed_mps2) {
  for (const int range_g : {2, 4, 8, 16})
    if (range_g * kStandardGravity_mps2 >= needed_mps2)
      return fmt::format("raise the range to {} or lower the limit", range_g);
  return "lower the limit: the widest range is 16";
}

std::string with_bias(int value, std::string_view unit, const std::array<double, 3>& bias) {
  const bool biased = std::ranges::any_of(bias, [](double b) { return b != 0.0; });
  return fmt::format("{} {}{}", value, unit, biased ? " less the calibrated bias" : "");
}

void check_imu(ContradictionList& list, const ImuConfig& imu, const std::string& key, const RobotConfig& c) {
  const auto& s = c.supervision;
  const double accel =
      carried(imu.accel_range_g * kStandardGravity_mps2, imu.accel_scale, imu.accel_bias_mps2);
  list.carries({key + "accel_range_g",
                with_bias(imu.accel_range_g, "g", imu.accel_bias_mps2),
                accel,
                {"supervision.imu_range_mps2", s.imu_range_mps2},
                s.imu_range_mps2,
                "m/s2",
                range_that_carries(s.imu_range_mps2)});
  const double gyro =
      carried(imu.gyro_range_dps * std::numbers::pi / 180.0, {1.0, 1.0, 1.0}, imu.gyro_bias_radps);
  list.carries({key + "gyro_range_dps",
                with_bias(imu.gyro_range_dps, "deg/s", imu.gyro_bias_radps),
                gyro,
                {"supervision.imu_gyro_radps", s.imu_gyro_radps},
                s.imu_gyro_radps,
                "rad/s",
                "raise the range or lower the limit"});
  list.carries({key + "rate_Hz",
                fmt::format("{}", imu.rate_Hz),
                static_cast<double>(imu.rate_Hz),
                {"supervision.imu_rate_Hz", s.imu_rate_Hz},
                s.imu_rate_Hz,
                "samples a second",
                "a sensor that keeps its rate would be called intermittent: raise the rate"});
  const double age_s =
      imu.latency_s + 1.0 / imu.rate_Hz + kTick_s + (imu.data_ready.fitted() ? 0.0 : imu.poll_period_s);
  list.carries(
      {key + "latency_s",
       fmt::format("limits.imu_age_s = {:g}", c.limits.imu_age_s),
       c.limits.imu_age_s,
       {key + "latency_s", imu.latency_s},
       age_s,
       "s",
       "with one period, one cycle and, without a data-ready line, one poll; raise limits.imu_age_s"});
  list.carries({key + "spi_speed_Hz",
                fmt::format("{}", imu.spi_speed_Hz),
                static_cast<double>(imu.spi_speed_Hz),
                {key + "rate_Hz", static_cast<double>(imu.rate_Hz)},
                2.0 * kSpiBitsPerSample * imu.rate_Hz,
                "bit/s",
                "144 bits a sample and as much again for set-up; raise the speed or lower the rate"});
  if (c.real_time.priority > 0)
    list.below({key + "thread_priority", static_cast<double>(imu.thread_priority)},
               {"real_time.priority", static_cast<double>(c.real_time.priority)},
               "a thread that reads a sensor would hold up the cycle");
}

void check_foot_accelerometer(ContradictionList& list, const LinuxBoardConfig& board, const RobotConfig& c) {
  const double accel = carried(board.imu_foot.accel_range_g * kStandardGravity_mps2,
                               board.imu_foot.accel_scale, board.imu_foot.accel_bias_mps2);
  const double needed = c.stiffness.joint.accel_range_mps2;
  list.carries({"imu_foot.accel_range_g",
                with_bias(board.imu_foot.accel_range_g, "g", board.imu_foot.accel_bias_mps2),
                accel,
                {"stiffness.joint.accel_range_mps2", needed},
                needed,
                "m/s2",
                range_that_carries(needed)});
}

// Only the kernel knows the range of an IIO converter; its driver's in_voltage_scale is read at the start.
void check_load_cell_range(ContradictionList& list, const LoadCellConfig& cell, const RobotConfig& c) {
  const auto& s = c.supervision;
  const double full_scale_V = kAdcFullScale_V[static_cast<std::size_t>(cell.range)];
  list.carries({"load_cell.scale_N_per_V",
                fmt::format("{:g} with {:g} V of range less zero_V = {:g}", cell.scale_N_per_V, full_scale_V,
                            cell.zero_V),
                cell.scale_N_per_V * (full_scale_V - std::abs(cell.zero_V)),
                {"supervision.load_cell_range_N", s.load_cell_range_N},
                s.load_cell_range_N,
                "N",
                "correct the scale, widen the range or lower the limit"});
}

void check_load_cell(ContradictionList& list, const LoadCellConfig& cell, const RobotConfig& c) {
  const auto& s = c.supervision;
  const bool is_iio = cell.is_iio() && cell.iio;
  if (!is_iio) check_load_cell_range(list, cell, c);
  const double rate_Hz = is_iio ? cell.iio->rate_Hz : kAdcRate_Hz[static_cast<std::size_t>(cell.rate)];
  list.carries({is_iio ? "load_cell.iio.rate_Hz" : "load_cell.rate",
                is_iio ? fmt::format("{:g}", rate_Hz) : std::string(name_of(cell.rate)),
                rate_Hz,
                {"supervision.load_cell_rate_Hz", s.load_cell_rate_Hz},
                s.load_cell_rate_Hz,
                "samples a second",
                is_iio ? "a sensor that keeps its rate would be called intermittent: lower the limit to the "
                         "converter's rate"
                       : "a sensor that keeps its rate would be called intermittent: raise the rate"});
  list.carries({"load_cell.latency_s",
                fmt::format("limits.load_cell_age_s = {:g}", c.limits.load_cell_age_s),
                c.limits.load_cell_age_s,
                {"load_cell.latency_s", cell.latency_s},
                cell.latency_s + 1.0 / rate_Hz + kTick_s,
                "s",
                "with one conversion and one cycle; raise limits.load_cell_age_s"});
  if (c.real_time.priority > 0)
    list.below({"load_cell.thread_priority", static_cast<double>(cell.thread_priority)},
               {"real_time.priority", static_cast<double>(c.real_time.priority)},
               "a thread that reads a sensor would hold up the cycle");
}

void check_tof(ContradictionList& list, const TofConfig& tof, const RobotConfig& c) {
  const auto& s = c.supervision;
  list.carries({"tof.range_max_m",
                fmt::format("{:g} with mount_offset_m = {:g}", tof.range_max_m, tof.mount_offset_m),
                tof.range_max_m + tof.mount_offset_m,
                {"supervision.tof_range_m", s.tof_range_m},
                s.tof_range_m,
                "m",
                "raise the range or lower the limit"});
  const double lowest_m = s.leg_length_min_m + c.robot.foot_height_m - c.stiffness.max_depth_m;
  list.add_if(
      tof.range_min_m + tof.mount_offset_m > lowest_m, "tof.range_min_m",
      fmt::format(
          "{:g} with mount_offset_m = {:g} sees no body below {:.4g} m, supervision.leg_length_min_m = "
          "{:g} lets it come down to {:.4g}: lower range_min_m or mount the sensor higher",
          tof.range_min_m, tof.mount_offset_m, tof.range_min_m + tof.mount_offset_m, s.leg_length_min_m,
          lowest_m));
  list.carries({"tof.frame_time_s",
                fmt::format("{:g}", tof.frame_time_s),
                1.0 / tof.frame_time_s,
                {"supervision.tof_rate_Hz", s.tof_rate_Hz},
                s.tof_rate_Hz,
                "frames a second",
                "a sensor that keeps its rate would be called intermittent: shorten the frame time"});
  list.carries({"tof.latency_s",
                fmt::format("limits.tof_age_s = {:g}", c.limits.tof_age_s),
                c.limits.tof_age_s,
                {"tof.latency_s", tof.latency_s},
                tof.latency_s + tof.frame_time_s + kTick_s,
                "s",
                "with one frame and one cycle; raise limits.tof_age_s"});
  if (c.real_time.priority > 0)
    list.below({"tof.thread_priority", static_cast<double>(tof.thread_priority)},
               {"real_time.priority", static_cast<double>(c.real_time.priority)},
               "a thread that reads a sensor would hold up the cycle");
}

}  // namespace

std::vector<Contradiction> contradictions(const LinuxBoardConfig& board, const RobotConfig& robot) {
  ContradictionList list;
  check_imu(list, board.imu_body, "imu_body.", robot);
  check_imu(list, board.imu_foot, "imu_foot.", robot);
  check_foot_accelerometer(list, board, robot);
  check_load_cell(list, board.load_cell, robot);
  check_tof(list, board.tof, robot);
  CanConfig can = board.can;
  can.motor = robot.motor;
  check_bus_load(can, [&](std::string_view key, const std::string& text) {
    list.add_if(true, "can." + std::string(key), text);
  });
  return list.take();
}

}  // namespace sandhopper
