#pragma once
#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>

namespace sandhopper::cli {

// Shows on standard error how far a task is, from two seconds on. A terminal shows one line (label, bar,
// percentage) that is redrawn, and erased by the destructor. Otherwise, as in a log or a pipe, a line is
// printed every ten seconds.
class Progress {
 public:
  // `total`: amount of work that at() counts up to.
  Progress(std::string label, double total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void at(double done);                           // call it from one thread at a time
  void at(double done, const std::string& step);  // `step`: shown as the work that is being done

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
  std::jthread teller_;  // last member, so that it stops before the members that it reads are destroyed
};

}  // namespace sandhopper::cli
