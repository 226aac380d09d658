#include "tools/plant/sensors.hpp"

#include <algorithm>

#include "tools/plant/plant.hpp"

namespace sandhopper {
namespace {

constexpr std::uint8_t kGoodQuality = 255;

double interpolated(double before, double now, double fraction) noexcept {
  return before + fraction * (now - before);
}

double with_noise(double value, double rms, Random& random) noexcept {
  return rms > 0.0 ? value + rms * random.normal() : value;
}

double rounded_to(double value, double resolution) noexcept {
  return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
}

}  // namespace

Imu::Imu(const Setup& setup, const SampleClock::Setup& clock, std::int64_t start_ns, const Random& random)
    : setup_(setup),
      clock_(clock, start_ns),
      filter_(setup.bandwidth_Hz, Plant::kStep_s),
      noise_memory_(std::exp(-2.0 * std::numbers::pi * setup.bandwidth_Hz / clock.rate_Hz)),
      noisy_(setup.noise_mps2 > 0.0 || setup.structure_noise_mps2 > 0.0 || setup.gyro_noise_radps > 0.0),
      random_(random) {
  if (noisy_)
    for (auto& unit : noise_) unit = random_.normal();
}

double Imu::coloured_noise(std::size_t axis) noexcept {
  noise_[axis] =
      noise_memory_ * noise_[axis] + std::sqrt(1.0 - noise_memory_ * noise_memory_) * random_.normal();
  return noise_[axis];
}

void Imu::step(const GridStep& step, const Input& input) noexcept {
  filter_.step(input.specific_force_mps2);
  while (step.contains(clock_.next_ns())) {
    sample_.time_ns = clock_.next_ns();
    ++sample_.samples;
    const double structure = input.stance ? setup_.structure_noise_mps2 : 0.0;
    const double accel_noise = std::hypot(setup_.noise_mps2, structure);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double force = axis == 2 ? filter_.at(step.fraction(sample_.time_ns)) : input.lateral_mps2[axis];
      double accel = (1.0 + setup_.scale_relative) * force;
      double rate = setup_.gyro_bias_radps[axis];
      accel += setup_.raw_offset_mps2[axis] + (input.released ? setup_.bias_mps2[axis] : 0.0);
      if (noisy_) {
        accel += accel_noise * coloured_noise(axis);
        rate += setup_.gyro_noise_radps * coloured_noise(axis + 3);
      }
      accel = std::clamp(accel, -setup_.range_mps2, setup_.range_mps2);
      sample_.accel_mps2[axis] = rounded_to(accel, setup_.resolution_mps2);
      sample_.gyro_radps[axis] = rate;
    }
    clock_.advance();
  }
}

TimeOfFlight::TimeOfFlight(const Setup& setup, const SampleClock::Setup& clock, std::int64_t start_ns,
                           const Random& random)
    : setup_(setup),
      clock_(clock, start_ns),
      latency_ns_(std::llround(setup.latency_s * 1e9)),
      random_(random) {}

void TimeOfFlight::step(const GridStep& step, double height_m) noexcept {
  while (step.contains(clock_.next_ns())) {
    auto& taken = underway_[(first_ + count_) % kUnderway];
    taken.time_ns = clock_.next_ns();
    const double height = interpolated(height_m_, height_m, step.fraction(taken.time_ns));
    taken.height_m = with_noise(height + setup_.bias_m, setup_.noise_m, random_);
    taken.amplitude = 100.0;
    taken.quality = kGoodQuality;
    count_ = std::min(count_ + 1, kUnderway);
    clock_.advance();
  }
  height_m_ = height_m;
  while (count_ > 0 && underway_[first_].time_ns + latency_ns_ <= step.to_ns) {
    sample_ = underway_[first_];
    first_ = (first_ + 1) % kUnderway;
    --count_;
  }
}

std::int64_t TimeOfFlight::next_sample_ns() const noexcept {
  return (count_ > 0 ? underway_[first_].time_ns : clock_.next_ns()) + latency_ns_;
}

LoadCell::LoadCell(const Setup& setup, const SampleClock::Setup& clock, std::int64_t start_ns,
                   const Random& random)
    : setup_(setup),
      clock_(clock, start_ns),
      amplifier_(setup.bandwidth_Hz, Plant::kStep_s),
      random_(random) {}

void LoadCell::step(const GridStep& step, double force_N) noexcept {
  amplifier_.step(force_N);
  while (step.contains(clock_.next_ns())) {
    sample_.time_ns = clock_.next_ns();
    ++sample_.samples;
    const double force = amplifier_.at(step.fraction(sample_.time_ns));
    sample_.force_N = with_noise(force + setup_.offset_N, setup_.noise_N, random_);
    clock_.advance();
  }
}

Mocap::Mocap(double noise_m, const SampleClock::Setup& clock, std::int64_t start_ns, const Random& random)
    : noise_m_(noise_m), clock_(clock, start_ns), random_(random) {}

void Mocap::step(const GridStep& step, const Input& input) noexcept {
  while (step.contains(clock_.next_ns())) {
    frame_.time_ns = clock_.next_ns();
    const double fraction = step.fraction(frame_.time_ns);
    frame_.body_z_m = with_noise(interpolated(before_.body_z_m, input.body_z_m, fraction), noise_m_, random_);
    frame_.foot_z_m = with_noise(interpolated(before_.foot_z_m, input.foot_z_m, fraction), noise_m_, random_);
    clock_.advance();
  }
  before_ = input;
}

}  // namespace sandhopper
