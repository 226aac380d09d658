#pragma once
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

namespace sandhopper::cli {

// Tells on standard error how far a piece of work is, once it has lasted two seconds: on a terminal a line
// that overwrites itself (label, bar, share done) and is wiped when the object goes; elsewhere, as in a log
// or a pipe, a line every ten seconds, whether the work has advanced or not.
class Progress {
 public:
  Progress(std::string label, double total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double done);                           // by one thread at a time
  void at(double done, const std::string& step);  // `step`: what is done now, for the line

 private:
  using Clock = std::chrono::steady_clock;

  std::string step() const;  // " fitting effects,", or empty
  double share() const;
  double elapsed_s() const;
  void draw();
  void tell(const std::stop_token& stop) const;

  std::string label_;
  double total_;
  bool on_terminal_;
  bool shown_ = false;
  std::atomic<double> done_{0.0};
  mutable std::mutex of_step_;
  std::string step_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_{};
  std::jthread teller_;  // last, so that it ends before what it reads
};

}  // namespace sandhopper::cli
