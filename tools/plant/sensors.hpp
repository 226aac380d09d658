#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "drivers/samples.hpp"
#include "tools/plant/random.hpp"

// Sensors with their own clocks. Each is stepped along the plant's 0.1 ms grid with its input at the grid
// points. It publishes a sample when one of its own sampling instants, and its latency, have passed. The time
// stamp is the instant of measurement; the value is interpolated between grid points.
namespace sandhopper {

// Sampling instants start + (phase + n) period, with a constant relative clock error.
class SampleClock {
 public:
  struct Setup {
    double rate_Hz;
    double clock_error_relative;
    double phase_periods;  // in (0, 1]: fraction of a period to the first sample
  };
  SampleClock(const Setup& setup, std::int64_t start_ns)
      : start_ns_(start_ns),
        period_ns_(1e9 / (setup.rate_Hz * (1.0 + setup.clock_error_relative))),
        phase_(setup.phase_periods) {
    set_next();
  }

  std::int64_t next_ns() const noexcept { return next_ns_; }
  void advance() noexcept {
    ++count_;
    set_next();
  }

 private:
  void set_next() noexcept {
    next_ns_ = start_ns_ + std::llround((phase_ + static_cast<double>(count_)) * period_ns_);
  }

  std::int64_t start_ns_;
  double period_ns_;
  double phase_;
  std::int64_t count_ = 0;
  std::int64_t next_ns_ = 0;
};

// First-order low-pass, exact for an input held over a step.
class LowPass {
 public:
  LowPass(double bandwidth_Hz, double step_s)
      : gain_(1.0 - std::exp(-2.0 * std::numbers::pi * bandwidth_Hz * step_s)) {}
  void reset(double value) noexcept { before_ = value_ = value; }
  void step(double input) noexcept {
    before_ = value_;
    value_ += gain_ * (input - value_);
  }
  double value() const noexcept { return value_; }
  // Output between the last two steps; fraction 1 is the newest.
  double at(double fraction) const noexcept { return before_ + fraction * (value_ - before_); }

 private:
  double gain_;
  double before_ = 0.0;
  double value_ = 0.0;
};

// One step of the plant's grid.
struct GridStep {
  std::int64_t from_ns;
  std::int64_t to_ns;

  bool contains(std::int64_t time_ns) const noexcept { return time_ns > from_ns && time_ns <= to_ns; }
  double fraction(std::int64_t time_ns) const noexcept {
    return static_cast<double>(time_ns - from_ns) / static_cast<double>(to_ns - from_ns);
  }
};

// Accelerometer and gyro on a vertical rail. z contains the specific force along the rail; x and y contain
// the gravity on a robot that is laid on its side. Angular rates contain only noise and offsets. Noise is
// white within the sensor's bandwidth; structure noise is added in stance.
class Imu {
 public:
  struct Setup {
    double bandwidth_Hz = 400.0;
    double range_mps2 = 156.9064;
    double noise_mps2 = 0.0;
    double structure_noise_mps2 = 0.0;
    double resolution_mps2 = 0.0;
    double gyro_noise_radps = 0.0;
    double scale_relative = 0.0;
    std::array<double, 3> raw_offset_mps2{};  // always present
    std::array<double, 3> bias_mps2{};        // present from the release on
    std::array<double, 3> gyro_bias_radps{};
  };
  Imu(const Setup& setup, const SampleClock::Setup& clock, std::int64_t start_ns, const Random& random);

  struct Input {
    double specific_force_mps2;  // along z
    bool stance;
    bool released;
    std::array<double, 2> lateral_mps2{};  // along x and y; changes too slowly for the filter to matter
  };
  void reset(double specific_force_mps2) noexcept { filter_.reset(specific_force_mps2); }
  void step(const GridStep& step, const Input& input) noexcept;

  const ImuSample& sample() const noexcept { return sample_; }
  std::int64_t next_sample_ns() const noexcept { return clock_.next_ns(); }

 private:
  double coloured_noise(std::size_t axis) noexcept;

  Setup setup_;
  SampleClock clock_;
  LowPass filter_;
  double noise_memory_;  // correlation of band-limited noise between consecutive samples
  bool noisy_;
  Random random_;
  std::array<double, 6> noise_{};  // unit variance
  ImuSample sample_{};
};

// Height of the hip axis over the surface, available `latency_s` after its measurement.
class TimeOfFlight {
 public:
  struct Setup {
    double latency_s = 0.0;
    double noise_m = 0.0;
    double bias_m = 0.0;
  };
  TimeOfFlight(const Setup& setup, const SampleClock::Setup& clock, std::int64_t start_ns,
               const Random& random);

  void reset(double height_m) noexcept { height_m_ = height_m; }
  void step(const GridStep& step, double height_m) noexcept;

  const TofSample& sample() const noexcept { return sample_; }
  std::int64_t next_sample_ns() const noexcept;

 private:
  static constexpr std::size_t kUnderway = 512;  // more than the number of samples within the longest latency
                                                 // at the highest rate

  Setup setup_;
  SampleClock clock_;
  std::int64_t latency_ns_;
  Random random_;
  double height_m_ = 0.0;
  std::array<TofSample, kUnderway> underway_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  TofSample sample_{};
};

// Load cell with an amplifier (first-order) and a free-running converter that holds its last value.
class LoadCell {
 public:
  struct Setup {
    double bandwidth_Hz = 300.0;
    double noise_N = 0.0;
    double offset_N = 0.0;
  };
  LoadCell(const Setup& setup, const SampleClock::Setup& clock, std::int64_t start_ns, const Random& random);

  void step(const GridStep& step, double force_N) noexcept;

  const LoadCellSample& sample() const noexcept { return sample_; }
  std::int64_t next_sample_ns() const noexcept { return clock_.next_ns(); }

 private:
  Setup setup_;
  SampleClock clock_;
  LowPass amplifier_;
  Random random_;
  LoadCellSample sample_{};
};

// Motion capture: positions of body and foot in one camera frame, in the laboratory's frame.
struct MocapFrame {
  std::int64_t time_ns = 0;
  double body_z_m = kNotMeasured;
  double foot_z_m = kNotMeasured;
};

class Mocap {
 public:
  Mocap(double noise_m, const SampleClock::Setup& clock, std::int64_t start_ns, const Random& random);

  struct Input {
    double body_z_m, foot_z_m;
  };
  void reset(const Input& input) noexcept { before_ = input; }
  void step(const GridStep& step, const Input& input) noexcept;

  const MocapFrame& frame() const noexcept { return frame_; }

 private:
  double noise_m_;
  SampleClock clock_;
  Random random_;
  Input before_{};
  MocapFrame frame_{};
};

}  // namespace sandhopper
