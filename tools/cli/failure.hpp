#pragma once
#include <stdexcept>
#include <string>

namespace sandhopper::cli {

// Exit status of `hop`.
enum class ExitCode : int {
  ok = 0,     // done
  no = 1,     // done, and the answer is no: a check failed, a replay differs
  usage = 2,  // wrong command line or configuration; nothing was started
  fault = 3   // hardware or system error
};

// Ends a verb with a message and a cure. Any other exception ends it with `fault` and no cure.
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
