#pragma once
#include <atomic>
#include <mutex>
#include <thread>

#include "drivers/unique_fd.hpp"
#include "firmware/hop_session.hpp"
#include "tools/trial/live/cycle_link.hpp"
#include "tools/trial/sim_trial.hpp"

namespace sandhopper {

// Runs the cycle with the simulated robot in a thread of this process, at `speed` times real time for
// watching. Its time is virtual: a busy computer makes it slow but causes no overruns.
class SimulatedLink : public CycleLink {
 public:
  SimulatedLink(const SimTrialSetup& setup, double speed, int status_Hz);
  ~SimulatedLink() override;

  void send(std::string_view word) override;
  int descriptor() const override { return news_.get(); }
  bool take(std::vector<std::string>& lines) override;

 private:
  void run(const SimTrialSetup& setup, double speed);
  void tell_status(int rate_Hz);
  void say(std::string line);

  UniqueFd news_;
  std::mutex mutex_;
  std::vector<std::string> lines_;
  bool ended_ = false;
  RequestBox requests_;
  std::atomic<Quit> quit_{Quit::no};
  std::atomic<bool> cycle_over_{false};
  Latest<LiveStatus> status_;
  std::thread cycle_;
  std::thread teller_;
};

}  // namespace sandhopper
