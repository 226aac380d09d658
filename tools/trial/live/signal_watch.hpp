#pragma once
#include <signal.h>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// While it exists, signals that would end this process (SIGINT, SIGTERM, SIGHUP) and a terminal's resize
// (SIGWINCH) are read by one thread through next(), so that a trial can end in order. Construct it before any
// thread starts.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  int descriptor() const { return fd_.get(); }
  int next();  // number of a signal; 0: none

 private:
  sigset_t before_{};
  UniqueFd fd_;
};

}  // namespace sandhopper
