// Cost of the transmit guard per frame: a cycle's two frames and two answers through a port that does
// nothing, with and without the guard, for each dialect. Both variants run in turn; the cost is their
// difference divided by the number of frames sent.
#include <benchmark/benchmark.h>

#include <ctime>

#include "drivers/transmit_guard/guarded_port.hpp"

namespace sandhopper {
namespace {

using transmit::Allowance;
using transmit::Dialect;

can_frame frame_of(canid_t id, std::uint64_t bits, std::uint8_t length = 8) {
  can_frame frame{};
  frame.can_id = id;
  frame.can_dlc = length;
  for (unsigned i = 0; i < length; ++i) frame.data[i] = static_cast<std::uint8_t>(bits >> (56U - 8U * i));
  return frame;
}

struct Frames {
  can_frame enter, zero, torque, reply;
};

Frames frames_of(Dialect dialect, canid_t id) {
  const canid_t extended = CAN_EFF_FLAG | id;
  const auto status = frame_of(extended | 0x2900U, 0x0032'0003'0000'1E00U);
  if (dialect == Dialect::v3) {
    const auto zero = frame_of(extended | 0x800U, 0x0000'007F'FF7F'F7FFU);
    return {zero, zero, frame_of(extended | 0x800U, 0x0000'007F'FF7F'F820U), status};
  }
  if (dialect == Dialect::servo) {
    const auto zero = frame_of(extended | 0x100U, 0, 4);
    return {zero, zero, frame_of(extended | 0x100U, 0x0000'03E8'0000'0000U, 4), status};
  }
  return {frame_of(id, 0xFFFF'FFFF'FFFF'FFFCU), frame_of(id, 0x7FFF'7FF0'0000'07FFU),
          frame_of(id, 0x7FFF'7FF0'0000'0820U),
          frame_of(0, static_cast<std::uint64_t>(id) << 56 | 0x80'0080'07FF'4600U)};
}

// Accepts every frame and answers it.
class Sink final : public CanPort {
 public:
  explicit Sink(Dialect dialect) {
    for (unsigned i = 0; i < kMotorCount; ++i) batch_[i].frame = frames_of(dialect, i + 1).reply;
  }
  void begin_cycle() noexcept override { now_ns_ += 1'000'000; }
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override {
    benchmark::DoNotOptimize(frame.data[7]);
    return now_ns_;
  }
  std::span<const ReceivedFrame> receive(bool& more) noexcept override {
    more = false;
    return batch_;
  }
  void pause(std::int64_t) noexcept override {}
  bool wait(std::int64_t) noexcept override { return true; }
  const CanCounters& counters() const noexcept override { return counters_; }
  void set_tap(CanTap*) noexcept override {}

 private:
  std::array<ReceivedFrame, kMotorCount> batch_{};
  CanCounters counters_{};
  std::int64_t now_ns_ = 0;
};

transmit::Limits limits_of(Dialect dialect) {
  transmit::Limits limits;
  for (unsigned i = 0; i < kMotorCount; ++i) {
    limits.motor[i].dialect = dialect;
    limits.motor[i].can_id = i + 1;
    if (dialect == Dialect::servo) limits.motor[i].status_rate_Hz = 500.0;
  }
  return limits;
}

class Cycles {
 public:
  Cycles(Dialect dialect, bool guarded) {
    for (unsigned i = 0; i < kMotorCount; ++i) frames_[i] = frames_of(dialect, i + 1);
    std::unique_ptr<CanPort> port = std::make_unique<Sink>(dialect);
    if (guarded) {
      auto made = std::make_unique<GuardedPort>(std::move(port), limits_of(dialect));
      guard_ = made.get();
      port = std::move(made);
    }
    port_ = std::move(port);
    run(&Frames::enter);
    for (int i = 0; i < 3; ++i) run(&Frames::zero);
  }
  void run(can_frame Frames::*sent = &Frames::torque) {
    bool more = false;
    benchmark::DoNotOptimize(port_->receive(more).data());
    now_ns_ += 1'000'000;
    if (guard_ != nullptr)
      guard_->begin({.now_ns = now_ns_, .allowance = Allowance::motion, .emergency_stop = false});
    port_->begin_cycle();
    for (const auto& f : frames_) benchmark::DoNotOptimize(port_->send(f.*sent));
  }
  bool refused() const { return guard_ != nullptr && guard_->refused().count > 0; }

 private:
  std::array<Frames, kMotorCount> frames_{};
  std::unique_ptr<CanPort> port_;
  GuardedPort* guard_ = nullptr;
  std::int64_t now_ns_ = 0;
};

// CPU time of this thread, so that other programs do not count.
double thread_time_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

void guard_price(benchmark::State& state) {
  const auto dialect = static_cast<Dialect>(state.range(0));
  constexpr int kCycles = 1000;
  Cycles bare(dialect, false), guarded(dialect, true);
  double bare_ns = 0.0, guarded_ns = 0.0, frames = 0.0;
  const auto time = [](Cycles& cycles) {
    const double before_ns = thread_time_ns();
    for (int i = 0; i < kCycles; ++i) cycles.run();
    return thread_time_ns() - before_ns;
  };
  for (auto _ : state) {
    bare_ns += time(bare);
    guarded_ns += time(guarded);
    frames += kCycles * static_cast<double>(kMotorCount);
  }
  if (guarded.refused()) state.SkipWithError("a frame was refused");
  state.counters["bare_ns_per_frame"] = bare_ns / frames;
  state.counters["guarded_ns_per_frame"] = guarded_ns / frames;
  state.counters["guard_ns_per_frame"] = (guarded_ns - bare_ns) / frames;
  state.counters["ratio"] = guarded_ns / bare_ns;
}
BENCHMARK(guard_price)->ArgName("dialect")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sandhopper
