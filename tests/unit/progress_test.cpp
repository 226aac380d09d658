#include "tools/cli/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <string>

namespace sandhopper::cli {
namespace {

// Redirects standard error into a pipe, as in a script, during its lifetime.
class PipedError {
 public:
  PipedError() : before_(::dup(STDERR_FILENO)) {
    if (::pipe(ends_.data()) == 0) ::dup2(ends_[1], STDERR_FILENO);
  }
  ~PipedError() {
    ::dup2(before_, STDERR_FILENO);
    for (const int end : {before_, ends_[0], ends_[1]}) ::close(end);
  }
  PipedError(const PipedError&) = delete;
  PipedError& operator=(const PipedError&) = delete;

  // Waits for a line and returns it.
  std::string line() const {
    std::string text;
    char letter = 0;
    while (::read(ends_[0], &letter, 1) == 1 && letter != '\n') text += letter;
    return text;
  }

 private:
  int before_;
  std::array<int, 2> ends_{};
};

TEST(Progress, TellsItselfInAPipeThoughTheWorkDoesNotAdvance) {
  const PipedError error;
  Progress progress("diagnosing", 4.0);
  progress.at(1.0);
  EXPECT_THAT(error.line(), ::testing::MatchesRegex("diagnosing: 25 %, [0-9]+ s so far"));
}

TEST(Progress, TellsNoShareOfWorkOfUnknownLength) {
  const PipedError error;
  const Progress progress("reading frames", 0.0);
  EXPECT_THAT(error.line(), ::testing::MatchesRegex("reading frames: [0-9]+ s so far"));
}

}  // namespace
}  // namespace sandhopper::cli
