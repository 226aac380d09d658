#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "drivers/samples.hpp"
#include "tools/faults/injection.hpp"
#include "tools/plant/random.hpp"

namespace sandhopper::faults {

// Size of the timing faults of one kind of sensor. Each value is far outside a sound sensor's behaviour, but
// no larger than a real defect.
struct SensorDefect {
  std::int64_t slow_period_ns;
  std::int64_t delay_ns;
  int keep_one_in;  // intermittent: passes one of so many samples
};

// Defect sizes of this kind of sensor.
template <class Sample>
SensorDefect defect_of();
// Changes a sample as a sensor with this kind of fault would. Timing faults change nothing here.
void spoil(ImuSample& sample, Kind kind, Random& random);
void spoil(TofSample& sample, Kind kind, Random& random);
void spoil(LoadCellSample& sample, Kind kind, Random& random);

// Stands between a sensor of the world and the frame: takes each new sample and delivers what the faulty
// sensor would deliver.
template <class Sample>
class SensorFault {
 public:
  explicit SensorFault(std::uint64_t seed) : random_(seed, 1) {}

  // std::nullopt: a sound sensor again.
  void set(std::optional<Kind> kind, std::int64_t now_ns) {
    kind_ = kind;
    since_ns_ = now_ns;
    samples_ = 0;
    head_ = tail_ = 0;
    frozen_ = held_;
  }

  // `newest`: the world's newest sample. `out`: this cycle's sample; out.fresh is true if one arrived in this
  // cycle.
  void pass(const Sample& newest, std::int64_t now_ns, Sample& out) {
    out.fresh = false;
    if (newest.time_ns != last_ns_ && newest.time_ns != 0) {
      last_ns_ = newest.time_ns;
      if (!kind_)
        deliver(newest, out);
      else
        pass_faulty(newest, out);
    }
    if (kind_ == Kind::delayed) release(now_ns, out);
    held_ = out;
  }

 private:
  static constexpr std::size_t kUnderway = 512;

  void deliver(const Sample& sample, Sample& out) {
    out = sample;
    out.fresh = true;
  }

  void pass_faulty(const Sample& newest, Sample& out) {
    const auto defect = defect_of<Sample>();
    ++samples_;
    switch (*kind_) {
      case Kind::off:
        return;
      case Kind::slow:
        if (newest.time_ns - since_ns_ < defect.slow_period_ns) return;
        since_ns_ = newest.time_ns;
        return deliver(newest, out);
      case Kind::intermittent:
        if (samples_ % defect.keep_one_in == 0) deliver(newest, out);
        return;
      case Kind::delayed:
        underway_[head_++ % kUnderway] = newest;
        return;
      case Kind::stuck: {
        const auto time_ns = newest.time_ns;
        out = frozen_;
        out.time_ns = time_ns;
        out.fresh = true;
        return;
      }
      case Kind::future:
        deliver(newest, out);
        out.time_ns += 10'000'000;
        return;
      case Kind::backward:
        deliver(newest, out);
        out.time_ns = since_ns_ - std::int64_t{samples_} * 100'000;
        return;
      default:
        deliver(newest, out);
        spoil(out, *kind_, random_);
    }
  }

  void release(std::int64_t now_ns, Sample& out) {
    while (tail_ < head_ && underway_[tail_ % kUnderway].time_ns + defect_of<Sample>().delay_ns <= now_ns)
      deliver(underway_[tail_++ % kUnderway], out);
  }

  Random random_;
  std::optional<Kind> kind_;
  std::int64_t since_ns_ = 0;
  std::int64_t last_ns_ = 0;
  int samples_ = 0;
  Sample frozen_{};
  Sample held_{};
  std::array<Sample, kUnderway> underway_{};
  std::size_t head_ = 0, tail_ = 0;
};

}  // namespace sandhopper::faults
