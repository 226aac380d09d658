#pragma once
#include "tools/trial/live/cycle_link.hpp"
#include "tools/trial/live/signal_watch.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// How often the cycle's process tells how it stands, for the view's plots.
inline constexpr int kLiveStatus_Hz = 50;

struct LiveTrialEnd {
  State last_state = State::idle;
  Fault last_fault = Fault::none;
  bool connection_lost = false;  // SIGHUP, SIGTERM, or the terminal has gone: no more trials
  std::string ending;            // the exit summary in words
};

// One trial with the operator at the terminal: shows `model`, which `link` keeps up to date, and sends the
// words of the keys, until the operator quits and the log is closed. A lost connection or a signal stops the
// robot softly first. Throws std::runtime_error with the process's own message when it did not run.
LiveTrialEnd run_live_trial(CycleLink& link, TrialModel model, SignalWatch& signals);

}  // namespace sandhopper
