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
  std::uint32_t clock_steps = 0;  // of the date
  std::uint32_t watchdog_trips = 0;
  double longest_stall_s = 0.0;  // as the watchdog saw it
  std::string log_error;         // the log's first trouble with its disk; empty: none
  LatencyHistogram latency{};
  State last_state = State::idle;
  Fault last_fault = Fault::none;
};

// The cycle in real time: sleeps to the grid, takes the operator's request, runs a turn; until `quit`. What
// becomes of each word goes into the log (topic /request) and to the listener.
class HopSession {
 public:
  HopSession(const RobotConfig& robot, Board& board, TrialLogger& logger, Aftermath::Listener listener,
             const StartState& start = {});

  // What a run stands between. The defaults are the real ones.
  struct World {
    const std::atomic<Quit>& quit;
    RequestBox& requests;
    Heartbeat& heart;
    std::function<void(const std::string&)> say;  // warnings, before the first cycle
    TimeSource& time = monotonic_time();
    WallClock wall_clock{};
    Latest<LiveStatus>* status = nullptr;  // who watches the cycle, if anyone does
    FreezeRing* freeze = nullptr;          // with it, a soft end waits for the second after a fault
    Latest<StateSample>* state = nullptr;  // who keeps the robot's state, if anyone does
  };
  // On the calling thread, which is made real-time.
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
