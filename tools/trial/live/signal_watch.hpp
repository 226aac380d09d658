#pragma once
#include <signal.h>

#include "drivers/unique_fd.hpp"

namespace sandhopper {

// While it lives, what would end this process (SIGINT, SIGTERM, SIGHUP) and a terminal's resize (SIGWINCH)
// come as news to its one thread that looks, so that it can end a trial in order. Make it before any thread.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

  int descriptor() const { return fd_.get(); }
  int next();  // a signal's number; 0: none

 private:
  sigset_t before_{};
  UniqueFd fd_;
};

}  // namespace sandhopper
