#include "firmware/realtime.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "drivers/clock.hpp"

namespace sandhopper {
namespace {

std::string why(int error) { return std::strerror(error); }

// Touches the stack that the thread may use, so that no page of it is missing later.
__attribute__((noinline)) void touch_stack(std::size_t bytes) {
  volatile char* const page = static_cast<volatile char*>(__builtin_alloca(bytes));
  for (std::size_t i = 0; i < bytes; i += 4096) page[i] = 0;
}

}  // namespace

RealTimeThread::RealTimeThread(const RealTimeConfig& config) {
  pthread_setname_np(pthread_self(), "cycle");
  if (config.lock_memory && mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    warnings_.push_back(
        fmt::format("memory is not locked ({}): raise `ulimit -l` or give CAP_IPC_LOCK", why(errno)));
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  if (config.stack_prefault_kB > 0) touch_stack(static_cast<std::size_t>(config.stack_prefault_kB) * 1024);

  if (config.cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(config.cpu), &set);
    if (const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set); error != 0)
      warnings_.push_back(fmt::format(
          "not pinned to CPU {} ({}): set real_time.cpu to one that exists, or -1", config.cpu, why(error)));
  }
  if (config.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = config.priority;
    if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters); error != 0)
      warnings_.push_back(fmt::format("no SCHED_FIFO {} ({}): raise `ulimit -r` or give CAP_SYS_NICE",
                                      config.priority, why(error)));
  }
  if (config.hold_cpu_awake) {
    latency_fd_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
    const std::int32_t zero_us = 0;
    if (latency_fd_ < 0 || write(latency_fd_, &zero_us, sizeof zero_us) != sizeof zero_us)
      warnings_.push_back(
          fmt::format("CPU may sleep deeply (/dev/cpu_dma_latency: {}): run with access to it, or set "
                      "real_time.hold_cpu_awake = false",
                      why(errno)));
  }
}

RealTimeThread::~RealTimeThread() {
  if (latency_fd_ >= 0) close(latency_fd_);
  sched_param ordinary{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
}

void LatencyHistogram::add(std::int64_t late_ns) noexcept {
  const auto bin = static_cast<std::size_t>(std::max<std::int64_t>(late_ns, 0) / 1000);
  ++bins_[std::min(bin, kBins - 1)];
  ++octaves_[std::min(static_cast<std::size_t>(std::bit_width(bin)), kOctaves - 1)];
  ++count_;
  last_ns_ = late_ns;
  largest_ns_ = std::max(largest_ns_, late_ns);
}

double LatencyHistogram::quantile_us(double share) const noexcept {
  const double wanted = share * static_cast<double>(count_);
  double seen = 0.0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    seen += static_cast<double>(bins_[bin]);
    if (seen >= wanted) return bin + 1 < kBins ? static_cast<double>(bin + 1) : largest_us();
  }
  return largest_us();
}

std::string LatencyHistogram::as_json() const {
  std::string text;
  for (std::size_t bin = 0; bin < kBins; ++bin)
    if (bins_[bin] != 0) text += fmt::format("{}[{},{}]", text.empty() ? "[" : ",", bin + 1, bins_[bin]);
  return text.empty() ? "[]" : text + "]";
}

namespace {

class Monotonic : public TimeSource {
 public:
  std::int64_t now_ns() noexcept override { return monotonic_ns(); }
  void sleep_until(std::int64_t time_ns) noexcept override {
    const timespec until{time_ns / kNanosecondsPerSecond, time_ns % kNanosecondsPerSecond};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }
};

}  // namespace

TimeSource& monotonic_time() noexcept {
  static Monotonic time;
  return time;
}

CycleClock::CycleClock(std::int64_t period_ns, TimeSource& time)
    : time_(time), period_ns_(period_ns), next_ns_((time.now_ns() / period_ns + 2) * period_ns) {}

std::int64_t CycleClock::wait() noexcept {
  const std::int64_t before_ns = time_.now_ns();
  if (before_ns >= next_ns_) {
    const std::int64_t missed = (before_ns - next_ns_) / period_ns_ + 1;
    next_ns_ += missed * period_ns_;
    cycle_ += static_cast<std::uint64_t>(missed);
    overruns_ += static_cast<std::uint32_t>(missed);
  }
  time_.sleep_until(next_ns_);
  const std::int64_t grid_ns = next_ns_;
  latency_.add(time_.now_ns() - grid_ns);
  next_ns_ += period_ns_;
  ++cycle_;
  return grid_ns;
}

}  // namespace sandhopper
