#include "tools/benchmark/process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <system_error>
#include <thread>

extern char** environ;

namespace sandhopper::benchmark {
namespace {

pid_t start(const std::vector<std::string>& command, const std::string& output, const std::string& errors) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // A process group of its own, so that all children can be killed together.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const auto& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, arguments.front(), &files, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error) throw std::system_error(error, std::generic_category(), "cannot start " + command.front());
  return pid;
}

}  // namespace

Outcome run_limited(const std::vector<std::string>& command, const std::filesystem::path& output,
                    const std::filesystem::path& errors, double limit_s) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const pid_t pid = start(command, output.string(), errors.string());
  Outcome outcome;
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  int status = 0;
  while (waitpid(pid, &status, WNOHANG) == 0) {
    if (!outcome.timed_out && seconds() > limit_s) {
      outcome.timed_out = true;
      kill(-pid, SIGKILL);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  outcome.seconds = seconds();
  outcome.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

}  // namespace sandhopper::benchmark
