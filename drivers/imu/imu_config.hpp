#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "config/fields.hpp"
#include "drivers/gpio/line_config.hpp"

namespace sandhopper {

// One ISM330DHCX on a spidev node.
struct ImuConfig {
  std::string device = "/dev/spidev0.0";
  int spi_speed_Hz = 8'000'000;
  // INT1, rising on every new sample. If it is not fitted the status register is polled every poll_period_s.
  LineConfig data_ready{};
  double poll_period_s = 0.0003;
  int rate_Hz = 1666;             // 416, 833, 1666, 3332 or 6667; there is no 1000
  int accel_range_g = 16;         // 2, 4, 8 or 16
  int gyro_range_dps = 2000;      // 125, 250, 500, 1000, 2000 or 4000
  int accel_lowpass_divisor = 4;  // LPF2 at rate/4, 10, 20, 45, 100, 200, 400 or 800; 2: LPF1 alone
  int gyro_lowpass_code = 0;  // FTYPE of LPF1; at 1666 Hz 0: 304, 1: 221, 2: 167, 3: 453, 4: 100, 5: 50 Hz
  // Rotation matrix: its rows are the robot's x, y and z axes (z up) in the sensor's axes.
  std::array<double, 9> mount{1, 0, 0, 0, 1, 0, 0, 0, 1};
  // Calibration along the sensor's own axes, before the mounting: specific force = accel_scale (raw -
  // accel_bias_mps2), rate = raw - gyro_bias_radps.
  std::array<double, 3> accel_scale{1, 1, 1};
  std::array<double, 3> accel_bias_mps2{0, 0, 0};
  std::array<double, 3> gyro_bias_radps{0, 0, 0};
  double latency_s = 0.0;    // age of a sample when data-ready rises: the filters' group delay
  int thread_priority = 60;  // SCHED_FIFO; 0: ordinary scheduling

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("device", self.device);
    visit("spi_speed_Hz", self.spi_speed_Hz, Range{100e3, 10e6});
    visit("data_ready", self.data_ready);
    visit("poll_period_s", self.poll_period_s, Range{5e-5, 0.1});
    visit("rate_Hz", self.rate_Hz, Range{416, 6667});
    visit("accel_range_g", self.accel_range_g, Range{2, 16});
    visit("gyro_range_dps", self.gyro_range_dps, Range{125, 4000});
    visit("accel_lowpass_divisor", self.accel_lowpass_divisor, Range{2, 800});
    visit("gyro_lowpass_code", self.gyro_lowpass_code, Range{0, 7});
    visit("mount", self.mount, Range{-1, 1});
    visit("accel_scale", self.accel_scale, Range{0.9, 1.1});
    visit("accel_bias_mps2", self.accel_bias_mps2, Range{-5, 5});
    visit("gyro_bias_radps", self.gyro_bias_radps, Range{-1, 1});
    visit("latency_s", self.latency_s, Range{0, 0.1});
    visit("thread_priority", self.thread_priority, Range{0, 98});
  }

  template <class Problem>
  void check(Problem&& problem) const {
    const auto one_of = [](int value, auto... allowed) { return ((value == allowed) || ...); };
    if (!one_of(rate_Hz, 416, 833, 1666, 3332, 6667))
      problem("rate_Hz", "must be 416, 833, 1666, 3332 or 6667");
    if (!one_of(accel_range_g, 2, 4, 8, 16)) problem("accel_range_g", "must be 2, 4, 8 or 16");
    if (!one_of(gyro_range_dps, 125, 250, 500, 1000, 2000, 4000))
      problem("gyro_range_dps", "must be 125, 250, 500, 1000, 2000 or 4000");
    if (!one_of(accel_lowpass_divisor, 2, 4, 10, 20, 45, 100, 200, 400, 800))
      problem("accel_lowpass_divisor", "must be 2, 4, 10, 20, 45, 100, 200, 400 or 800");
    if (!is_rotation())
      problem("mount", "must be a rotation: rows of unit length, at right angles, right-handed");
  }

  bool is_rotation() const {
    const auto& m = mount;
    double error = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        double dot = 0.0;
        for (std::size_t k = 0; k < 3; ++k) dot += m[3 * i + k] * m[3 * j + k];
        error = std::max(error, std::abs(dot - (i == j ? 1.0 : 0.0)));
      }
    const double determinant = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                               m[2] * (m[3] * m[7] - m[4] * m[6]);
    return error < 1e-3 && determinant > 0.0;
  }
};

}  // namespace sandhopper
