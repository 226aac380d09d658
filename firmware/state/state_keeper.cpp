#include "firmware/state/state_keeper.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "drivers/clock.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kLook_ns = 50'000'000;

}  // namespace

KeptState kept_state(const StateSample& sample, const StateClock& now, double period_s, bool closed) {
  KeptState state;
  state.boot_id = now.boot_id;
  state.boottime_ns = now.boottime_ns;
  state.realtime_ns = now.realtime_ns;
  state.clock_synchronised = now.synchronised;
  state.closed = closed;
  state.period_s = period_s;
  state.winding_C = sample.winding_C;
  state.housing_C = sample.housing_C;
  state.positions_known =
      std::ranges::all_of(sample.position_rad, [](double position) { return std::isfinite(position); });
  if (state.positions_known) state.position_rad = sample.position_rad;
  state.touchdowns = sample.touchdowns;
  state.fault = sample.fault;
  return state;
}

StateKeeper::StateKeeper(StatePlaces places, std::function<void(const std::string&)> say)
    : places_(std::move(places)), say_(std::move(say)), thread_([this] { run(); }) {}

StateKeeper::~StateKeeper() { stop(); }

void StateKeeper::stop() {
  stopping_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

void StateKeeper::close() {
  stop();
  look(true);
}

// The creating thread may have the cycle's priority, which threads inherit: return to ordinary scheduling.
void StateKeeper::run() {
  const sched_param ordinary{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &ordinary);
  ::pthread_setname_np(::pthread_self(), "state");
  while (!stopping_.load(std::memory_order_acquire)) {
    look(false);
    sleep_ns(kLook_ns);
  }
}

void StateKeeper::look(bool closing) {
  sampled_ = newest_.take(sample_) || sampled_;
  if (!sampled_) return;
  const auto now_ns = clock_ns(CLOCK_BOOTTIME);
  const bool at_once = closing || sample_.fault != written_fault_;
  if (at_once || now_ns >= boot_due_ns_) {
    boot_due_ns_ = now_ns + to_ns(kBootPeriod_s);
    write(places_.boot, kBootPeriod_s, closing);
  }
  if (at_once || now_ns >= lasting_due_ns_) {
    lasting_due_ns_ = now_ns + to_ns(kLastingPeriod_s);
    write(places_.lasting, kLastingPeriod_s, closing);
  }
  written_fault_ = sample_.fault;
}

void StateKeeper::write(const std::filesystem::path& file, double period_s, bool closing) {
  try {
    write_state_file(file, kept_state(sample_, state_clock(), period_s, closing));
  } catch (const std::system_error& error) {
    if (std::exchange(warned_, true)) return;
    say_(fmt::format(
        "the motors' temperatures are not kept, the next start assumes hot ones: {}; make the folder "
        "or name another with --state",
        error.what()));
  }
}

}  // namespace sandhopper
