#include "firmware/watchdog/guard_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <system_error>

#include "drivers/clock.hpp"
#include "firmware/watchdog/stall_detector.hpp"

namespace sandhopper {
namespace {

constexpr int kCutsAfterDeath = 100;
constexpr std::int64_t kBetweenCuts_ns = 1'000'000;
// Later than the torque watchdog's thread, which has already cut the torque if it can run at all.
constexpr double kStallFactor = 1.5;
constexpr int kLooks = 4;  // checks within cycle_stall_s
constexpr std::int64_t kPatienceAfterEnd_ns = 500'000'000;
constexpr std::size_t kMostDescriptors = 16;
// The kernel's out-of-memory killer never chooses a process with -1000. hopperd is just above: it is killed
// after all other processes and before its guard.
constexpr std::string_view kNeverKilled = "-1000";
constexpr std::string_view kKilledLast = "-900";

bool write_score(std::string_view score) noexcept {
  const UniqueFd file(::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC));
  return file && ::write(file.get(), score.data(), score.size()) == static_cast<ssize_t>(score.size());
}

bool is_never_killed() noexcept {
  const UniqueFd file(::open("/proc/self/oom_score_adj", O_RDONLY | O_CLOEXEC));
  char text[16]{};
  return file && ::read(file.get(), text, sizeof text - 1) > 0 && std::string_view(text) == "-1000\n";
}

// The child process. Between fork and _exit it may call only async-signal-safe functions.
class Guard {
 public:
  Guard(const GuardProcess::Setup& setup, int line) noexcept
      : setup_(setup),
        line_(line),
        look_ns_(to_ns(setup.config.cycle_stall_s) / kLooks),
        limit_ns_(to_ns(kStallFactor * setup.config.cycle_stall_s)) {}

  [[noreturn]] void run() noexcept {
    set_up();
    while (true) {
      switch (wait()) {
        case Message::dismissed:
          ::_exit(0);
        case Message::death:
          mourn();
        case Message::none:
          look();
      }
    }
  }

 private:
  enum class Message { none, dismissed, death };

  void set_up() const noexcept {
    ::setsid();
    ::prctl(PR_SET_NAME, "hopperd-guard");
    write_score(kNeverKilled);
    // SCHED_RESET_ON_FORK: the child that writes the file at a standstill gets ordinary priority.
    const sched_param parameters{.sched_priority = setup_.config.priority};
    if (parameters.sched_priority > 0) ::sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
    close_other_descriptors();
    ::mlockall(MCL_CURRENT | MCL_FUTURE);
  }

  void close_other_descriptors() const noexcept {
    std::array<unsigned, kMostDescriptors> kept{};
    std::size_t count = 0;
    const auto keep = [&](int fd) {
      if (fd >= 0 && count < kept.size()) kept[count++] = static_cast<unsigned>(fd);
    };
    keep(line_);
    keep(setup_.cut.descriptor());
    if (setup_.last_act != nullptr)
      for (const int fd : setup_.last_act->descriptors()) keep(fd);
    std::sort(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count));
    unsigned next = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (kept[i] > next) ::close_range(next, kept[i] - 1, 0);
      next = kept[i] + 1;
    }
    ::close_range(next, ~0U, 0);
  }

  // Waits until the next check, or until the parent's message or end.
  Message wait() const noexcept {
    pollfd line{line_, POLLIN, 0};
    const timespec timeout{look_ns_ / kNanosecondsPerSecond, look_ns_ % kNanosecondsPerSecond};
    if (::ppoll(&line, 1, &timeout, nullptr) <= 0) return Message::none;
    char dismissed = 0;
    const auto got = ::read(line_, &dismissed, 1);
    if (got < 0) return Message::none;
    return got == 1 ? Message::dismissed : Message::death;
  }

  [[noreturn]] void mourn() noexcept {
    for (int i = 0; i < kCutsAfterDeath; ++i) {
      setup_.cut.cut();
      sleep_ns(kBetweenCuts_ns);
    }
    const sched_param ordinary{};
    ::sched_setscheduler(0, SCHED_OTHER, &ordinary);
    if (writer_ > 0) ::waitpid(writer_, nullptr, 0);
    if (setup_.last_act != nullptr) setup_.last_act->run();
    ::_exit(0);
  }

  void look() noexcept {
    const auto now_ns = monotonic_ns();
    const auto stall_ns = detector_.see(setup_.heart, now_ns);
    const bool stalled = stall_ns >= limit_ns_;
    if (stalled) setup_.heart.trip(stall_ns);  // before the cut, so a waking cycle sends no old command
    const bool untaken = tripped_ && setup_.heart.beating() && setup_.heart.tripped();
    if (stalled || untaken || overdue(now_ns)) setup_.cut.cut();
    if (stalled && !tripped_) start_writer();
    tripped_ = stalled || untaken;
    if (writer_ > 0 && ::waitpid(writer_, nullptr, WNOHANG) == writer_) writer_ = -1;
  }

  bool overdue(std::int64_t now_ns) noexcept {
    if (!setup_.heart.ended())
      ended_since_ns_ = 0;
    else if (ended_since_ns_ == 0)
      ended_since_ns_ = now_ns;
    return ended_since_ns_ != 0 && now_ns - ended_since_ns_ >= kPatienceAfterEnd_ns;
  }

  // Runs the last act of a standstill in a child process, so that the cuts go on.
  void start_writer() noexcept {
    if (setup_.last_act == nullptr || writer_ > 0) return;
    writer_ = ::fork();
    if (writer_ != 0) return;
    setup_.last_act->run();
    ::_exit(0);
  }

  const GuardProcess::Setup& setup_;
  int line_;
  std::int64_t look_ns_;
  std::int64_t limit_ns_;
  StallDetector detector_;
  bool tripped_ = false;
  std::int64_t ended_since_ns_ = 0;
  pid_t writer_ = -1;
};

}  // namespace

GuardProcess::GuardProcess(const Setup& setup) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw std::system_error(errno, std::generic_category(), "line to the guard");
  const UniqueFd child_end(ends[0]);
  line_ = UniqueFd(ends[1]);
  // Block the signals before the fork, so that none reaches the child before it has blocked them itself.
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  child_ = ::fork();
  if (child_ == 0) Guard(setup, child_end.get()).run();
  const int error = errno;
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child_ < 0) throw std::system_error(error, std::generic_category(), "fork of the guard");
  if (is_never_killed()) write_score(kKilledLast);
}

GuardProcess::~GuardProcess() {
  if (line_) {
    // If the guard was killed, SIGPIPE must not end this process.
    [[maybe_unused]] const auto told = ::send(line_.get(), "q", 1, MSG_NOSIGNAL);
    line_ = UniqueFd();
  }
  if (child_ > 0) ::waitpid(child_, nullptr, 0);
}

bool GuardProcess::alive() noexcept {
  if (child_ > 0 && ::waitpid(child_, nullptr, WNOHANG) == child_) child_ = -1;
  return child_ > 0;
}

}  // namespace sandhopper
