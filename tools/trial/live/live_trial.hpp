#pragma once
#include "tools/trial/live/cycle_link.hpp"
#include "tools/trial/live/signal_watch.hpp"
#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// Rate at which the cycle's process sends its status for the plots.
inline constexpr int kLiveStatus_Hz = 50;

struct LiveTrialEnd {
  State last_state = State::idle;
  Fault last_fault = Fault::none;
  bool connection_lost = false;  // SIGHUP, SIGTERM, or the terminal is gone: no more trials
  std::string ending;            // the exit summary in words
};

// Runs one trial with the operator at the terminal: shows `model`, which `link` updates, and sends the words
// of the keys, until the operator quits and the log is closed. A lost connection or a signal first stops the
// robot softly. Throws std::runtime_error with the process's own message if it did not run.
LiveTrialEnd run_live_trial(CycleLink& link, TrialModel model, SignalWatch& signals);

}  // namespace sandhopper
