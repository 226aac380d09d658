#pragma once
#include <stdexcept>
#include <string>

namespace sandhopper::cli {

// What `hop` returns to the shell.
enum class ExitCode : int {
  ok = 0,     // did what was asked
  no = 1,     // ran, and the answer is no: a check failed, a replay differs
  usage = 2,  // the command line or the configuration is wrong; nothing was started
  fault = 3   // hardware or system
};

// Ends a verb with a message and what the user can do about it. Any other exception ends with `fault` and no
// cure.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode exit, const std::string& message, std::string cure)
      : std::runtime_error(message), exit_(exit), cure_(std::move(cure)) {}
  ExitCode exit() const noexcept { return exit_; }
  const std::string& cure() const noexcept { return cure_; }

 private:
  ExitCode exit_;
  std::string cure_;
};

}  // namespace sandhopper::cli
