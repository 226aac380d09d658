// Stops one thread of a process for a while, as nothing else does to it: the others run on. Or the whole
// process.
//   hold_thread PID NAME MILLISECONDS     NAME of the thread (/proc/PID/task/*/comm), or "all" for SIGSTOP,
//   SIGCONT
// Prints when it stood still: start and length [ms of CLOCK_MONOTONIC]. Exit status 77: not allowed to trace
// here.
#include <sys/ptrace.h>
#include <sys/types.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

double now_ms() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

void sleep_ms(long ms) {
  timespec t{ms / 1000, ms % 1000 * 1'000'000};
  while (nanosleep(&t, &t) != 0) {
  }
}

pid_t thread_named(const std::string& pid, const std::string& name) {
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + pid + "/task")) {
    std::string comm;
    std::getline(std::ifstream(task.path() / "comm"), comm);
    if (comm == name) return std::atoi(task.path().filename().c_str());
  }
  return 0;
}

// True if the state in /proc/PID/stat is 'T'.
bool stopped(const std::string& pid) {
  std::string text;
  std::getline(std::ifstream("/proc/" + pid + "/stat"), text);
  const auto end = text.rfind(") ");
  return end != std::string::npos && text[end + 2] == 'T';
}

int hold_all(const std::string& pid, long ms) {
  const auto process = std::atoi(pid.c_str());
  if (kill(process, SIGSTOP) != 0) return 1;
  while (!stopped(pid)) sleep_ms(1);
  const double start = now_ms();
  sleep_ms(ms);
  const double end = now_ms();
  kill(process, SIGCONT);
  std::printf("%.3f %.3f\n", start, end - start);
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) return 2;
  const long ms = std::atol(argv[3]);
  if (std::string(argv[2]) == "all") return hold_all(argv[1], ms);
  const pid_t thread = thread_named(argv[1], argv[2]);
  if (thread == 0) return 1;
  if (ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0) return errno == EPERM ? 77 : 1;
  ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr);
  waitpid(thread, nullptr, __WALL);
  const double start = now_ms();
  sleep_ms(ms);
  std::printf("%.3f %.3f\n", start, now_ms() - start);
  ptrace(PTRACE_DETACH, thread, nullptr, nullptr);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
