#pragma once
#include <atomic>
#include <cstdint>
#include <string>

#include "config/robot_config.hpp"
#include "firmware/board.hpp"
#include "firmware/cycle.hpp"
#include "firmware/realtime.hpp"

namespace sandhopper {

// The operator's requests on their way to the cycle: the newest one not yet taken. Any thread may post.
class RequestBox {
 public:
  void post(Request request) noexcept { request_.store(request, std::memory_order_release); }
  Request take() noexcept { return request_.exchange(Request::none, std::memory_order_acq_rel); }

 private:
  std::atomic<Request> request_{Request::none};
};

struct SessionResult {
  std::uint64_t cycles = 0;
  std::uint32_t overruns = 0;
  std::uint64_t lost_records = 0;
  std::uint64_t lost_can_frames = 0;
  std::string log_error;  // the log's first trouble with its disk; empty: none
  LatencyHistogram latency{};
  State last_state = State::idle;
  Fault last_fault = Fault::none;
};

// The cycle in real time: sleeps to the grid, takes the operator's request, runs a turn; until `quit`, which
// first asks for a soft stop and then waits for the drives to be off.
class HopSession {
 public:
  HopSession(const RobotConfig& robot, Board& board, TrialLogger& logger, Aftermath::Listener listener);

  // On the calling thread, which is made real-time. Warnings are printed by `say` before the first cycle.
  SessionResult run(const std::atomic<bool>& quit, RequestBox& requests,
                    const std::function<void(const std::string&)>& say);

 private:
  const RobotConfig& robot_;
  Board& board_;
  TrialLogger& logger_;
  TrialTopics topics_;
  Controller controller_;
  Aftermath aftermath_;
};

}  // namespace sandhopper
