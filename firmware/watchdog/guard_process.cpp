#include "firmware/watchdog/guard_process.hpp"

#include <fcntl.h>
#include <linux/close_range.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <system_error>

#include "drivers/clock.hpp"

namespace sandhopper {
namespace {

constexpr int kTries = 100;
constexpr std::int64_t kBetweenTries_ns = 1'000'000;

void close_all_but(int first, int second) {
  const auto low = static_cast<unsigned>(std::min(first, second));
  const auto high = static_cast<unsigned>(std::max(first, second));
  if (low > 0) ::close_range(0, low - 1, 0);
  if (high > low + 1) ::close_range(low + 1, high - 1, 0);
  ::close_range(high + 1, ~0U, 0);
}

// Between fork and _exit: only what a signal handler may call.
[[noreturn]] void guard(int line, TorqueCut& cut) {
  sigset_t all;
  sigfillset(&all);
  ::sigprocmask(SIG_BLOCK, &all, nullptr);
  ::setsid();  // what ends the parent's group does not end this
  ::prctl(PR_SET_NAME, "hopperd-guard");
  close_all_but(line, cut.descriptor());
  char dismissed = 0;
  ssize_t got = 0;
  while ((got = ::read(line, &dismissed, 1)) < 0 && errno == EINTR) {
  }
  if (got == 1) ::_exit(0);
  for (int i = 0; i < kTries; ++i) {
    cut.cut();
    sleep_ns(kBetweenTries_ns);
  }
  ::_exit(0);
}

}  // namespace

GuardProcess::GuardProcess(TorqueCut& cut) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const UniqueFd child_end(ends[0]);
  line_ = UniqueFd(ends[1]);
  child_ = ::fork();
  if (child_ < 0) throw std::system_error(errno, std::generic_category(), "fork of the guard");
  if (child_ == 0) guard(child_end.get(), cut);
}

GuardProcess::~GuardProcess() {
  if (line_) {
    [[maybe_unused]] const auto told = ::write(line_.get(), "q", 1);
  }
  ::waitpid(child_, nullptr, 0);
}

}  // namespace sandhopper
