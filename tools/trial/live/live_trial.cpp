#include "tools/trial/live/live_trial.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <stdexcept>

#include "drivers/clock.hpp"
#include "tools/trial/live/idle_close.hpp"
#include "tools/trial/live/live_terminal.hpp"
#include "tools/trial/live/operator_key.hpp"
#include "tools/trial/live/signal_watch.hpp"
#include "tools/trial/live/trial_screen.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kFrame_ns = 100'000'000;

class LiveTrial {
 public:
  LiveTrial(CycleLink& link, TrialModel& model, SignalWatch& signals)
      : link_(link), model_(model), signals_(signals), idle_(model.close_after_s) {}

  bool run() {
    while (!link_ended_) {
      wait();
      hear_signals();
      hear_link();
      hear_keys();
      close_after_trial();
      draw();
    }
    return connection_lost_;
  }

 private:
  // Waits until a frame is due or a descriptor has news.
  void wait() {
    const auto until_frame_ns = std::max<std::int64_t>(0, next_frame_ns_ - monotonic_ns());
    fds_ = {pollfd{connection_lost_ ? -1 : STDIN_FILENO, POLLIN, 0}, pollfd{signals_.descriptor(), POLLIN, 0},
            pollfd{link_.descriptor(), POLLIN, 0},
            pollfd{terminal_.ready() ? -1 : terminal_.output(), POLLOUT, 0}};
    ::poll(fds_.data(), fds_.size(), static_cast<int>(until_frame_ns / 1'000'000) + 1);
    terminal_.flush();
  }

  void hear_signals() {
    for (int signal = signals_.next(); signal != 0; signal = signals_.next()) {
      if (signal == SIGWINCH) {
        terminal_.forget();
        next_frame_ns_ = 0;
      } else {
        lose_connection(signal == SIGHUP);
      }
    }
  }

  // The shell and the kernel may both report a lost connection. Only a signal that somebody sends twice on
  // purpose ends the trial at once.
  void lose_connection(bool hung_up) {
    connection_lost_ = true;
    if (!hung_up || !model_.quitting) quit();
  }

  void quit() {
    link_.send("quit");
    model_.quitting = true;
  }

  void close_after_trial() {
    const bool is_over = model_.over && model_.state() == State::idle && !model_.quitting;
    if (idle_.is_due(is_over, monotonic_ns())) quit();
  }

  void hear_link() {
    std::vector<std::string> lines;
    link_ended_ = !link_.take(lines);
    for (const auto& line : lines) model_.take(line);
  }

  void hear_keys() {
    if ((fds_[0].revents & (POLLIN | POLLHUP | POLLERR | POLLNVAL)) == 0) return;
    std::u32string keys;
    if (!terminal_.read_keys(keys)) return lose_connection(true);
    for (const char32_t typed : keys) press(typed);
  }

  void press(char32_t typed) {
    idle_.key_pressed();
    const auto* key = operator_key(typed);
    if (key == nullptr) {
      model_.refusal = "no such key; the keys are on the line below";
    } else if (const auto reason = why_not(key->word, model_)) {
      model_.refusal = *reason;
    } else {
      model_.refusal.clear();
      key->word == "quit" ? quit() : link_.send(key->word);
    }
    next_frame_ns_ = 0;
  }

  void draw() {
    if (monotonic_ns() < next_frame_ns_ || !terminal_.ready()) return;
    next_frame_ns_ = monotonic_ns() + kFrame_ns;
    terminal_.show(trial_screen(model_, terminal_.size()));
  }

  CycleLink& link_;
  TrialModel& model_;
  SignalWatch& signals_;
  LiveTerminal terminal_;
  std::array<pollfd, 4> fds_{};
  std::int64_t next_frame_ns_ = 0;
  IdleClose idle_;
  bool link_ended_ = false;
  bool connection_lost_ = false;
};

}  // namespace

LiveTrialEnd run_live_trial(CycleLink& link, TrialModel model, SignalWatch& signals) {
  const bool lost = LiveTrial(link, model, signals).run();
  if (!model.ended)
    throw std::runtime_error(model.error.empty() ? "the cycle's process ended and said nothing"
                                                 : model.error);
  return {model.last_state, model.fault, lost, model.ending};
}

}  // namespace sandhopper
