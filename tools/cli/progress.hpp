#pragma once
#include <chrono>
#include <string>

namespace sandhopper::cli {

// A line on standard error that overwrites itself: label, bar, share done. Shown only on a terminal, and only
// once the work has lasted two seconds; wiped when the object goes.
class Progress {
 public:
  Progress(std::string label, double total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double done);

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  double total_;
  bool on_terminal_;
  bool shown_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_{};
};

}  // namespace sandhopper::cli
