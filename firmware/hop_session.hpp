#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "config/robot_config.hpp"
#include "drivers/latest.hpp"
#include "firmware/board.hpp"
#include "firmware/cycle.hpp"
#include "firmware/live_status.hpp"
#include "firmware/realtime.hpp"
#include "firmware/request_box.hpp"
#include "firmware/wall_clock.hpp"
#include "firmware/watchdog/heartbeat.hpp"

namespace sandhopper {

struct SessionResult {
  std::uint64_t cycles = 0;
  std::uint32_t overruns = 0;
  std::uint64_t lost_records = 0;
  std::uint64_t lost_can_frames = 0;
  std::uint32_t clock_steps = 0;  // number of steps of CLOCK_REALTIME
  std::uint32_t watchdog_trips = 0;
  double longest_stall_s = 0.0;  // measured by the watchdog
  std::string log_error;         // the log's first disk error; empty: none
  LatencyHistogram latency{};
  State last_state = State::idle;
  Fault last_fault = Fault::none;
};

// Runs the cycle in real time until `quit`: sleeps to the time grid, takes the operator's request, runs a
// turn. The outcome of each word goes into the log (topic /request) and to the listener.
class HopSession {
 public:
  HopSession(const RobotConfig& robot, Board& board, TrialLogger& logger, Aftermath::Listener listener,
             const StartState& start = {});

  // Environment of a run. The defaults are the real clocks.
  struct World {
    const std::atomic<Quit>& quit;
    RequestBox& requests;
    Heartbeat& heart;
    std::function<void(const std::string&)> say;  // warnings, before the first cycle
    TimeSource& time = monotonic_time();
    WallClock wall_clock{};
    Latest<LiveStatus>* status = nullptr;  // may be null
    FreezeRing* freeze = nullptr;          // may be null; if set, a soft end waits for the second after a
                                           // fault
    Latest<StateSample>* state = nullptr;  // samples for the state keeper; may be null
  };
  // Runs on the calling thread, which becomes real-time.
  SessionResult run(World world);

 private:
  void turn_until_quit(World& world, Cycle& cycle, CycleClock& clock, SessionResult& result);
  void tell_answers(std::span<RequestRecord> answers, const StepOutput& output) noexcept;
  void answer_the_rest(World& world, std::int64_t now_ns, const StepOutput& output) noexcept;

  const RobotConfig& robot_;
  Board& board_;
  TrialLogger& logger_;
  TrialTopics topics_;
  LogTopic<RequestRecord> request_topic_;
  Controller controller_;
  Aftermath aftermath_;
};

}  // namespace sandhopper
