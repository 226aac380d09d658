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
#include "firmware/wall_clock.hpp"
#include "firmware/watchdog/heartbeat.hpp"

namespace sandhopper {

// The operator's requests on their way to the cycle: the newest one not yet taken. Any thread may post.
class RequestBox {
 public:
  void post(Request request) noexcept { request_.store(request, std::memory_order_release); }
  Request take() noexcept { return request_.exchange(Request::none, std::memory_order_acq_rel); }

 private:
  std::atomic<Request> request_{Request::none};
};

// How to end. softly: stop the robot, wait until its drives are off. at_once: not even that; whoever owns the
// drives switches them off.
enum class Quit : std::uint8_t { no, softly, at_once };

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

// The cycle in real time: sleeps to the grid, takes the operator's request, runs a turn; until `quit`.
class HopSession {
 public:
  HopSession(const RobotConfig& robot, Board& board, TrialLogger& logger, Aftermath::Listener listener);

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
  };
  // On the calling thread, which is made real-time.
  SessionResult run(World world);

 private:
  void turn_until_quit(World& world, Cycle& cycle, CycleClock& clock, SessionResult& result);

  const RobotConfig& robot_;
  Board& board_;
  TrialLogger& logger_;
  TrialTopics topics_;
  Controller controller_;
  Aftermath aftermath_;
};

}  // namespace sandhopper
