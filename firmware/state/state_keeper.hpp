#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "drivers/latest.hpp"
#include "firmware/state/kept_state.hpp"
#include "firmware/state/recollection.hpp"
#include "firmware/state/start_state.hpp"

namespace sandhopper {

// Writes the robot's state to files: this boot's state every second, the lasting one every ten seconds, and
// both when the fault changes and at the end. Runs in a thread of ordinary priority; the cycle only copies a
// sample.
class StateKeeper {
 public:
  static constexpr double kBootPeriod_s = 1.0;
  static constexpr double kLastingPeriod_s = 10.0;

  // `say` reports the first write error, once.
  StateKeeper(StatePlaces places, std::function<void(const std::string&)> say);
  ~StateKeeper();
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  Latest<StateSample>& newest() noexcept { return newest_; }

  // For a run that ended in order: writes both states and ends the thread. Without this call the last files
  // count as those of a run that did not end in order.
  void close();

 private:
  void run();
  void look(bool closing);
  void write(const std::filesystem::path& file, double period_s, bool closing);
  void stop();

  StatePlaces places_;
  std::function<void(const std::string&)> say_;
  Latest<StateSample> newest_;
  StateSample sample_{};
  bool sampled_ = false;
  bool warned_ = false;
  Fault written_fault_ = Fault::none;
  std::int64_t boot_due_ns_ = 0;
  std::int64_t lasting_due_ns_ = 0;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

// Converts a sample to the state that is stored.
KeptState kept_state(const StateSample& sample, const StateClock& now, double period_s, bool closed);

}  // namespace sandhopper
