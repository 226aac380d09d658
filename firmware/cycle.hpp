#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "firmware/board.hpp"
#include "firmware/controller.hpp"
#include "firmware/freeze/freeze_ring.hpp"
#include "firmware/log/spsc_ring.hpp"
#include "firmware/log/trial_logger.hpp"
#include "firmware/request_box.hpp"
#include "terrain/ground_events.hpp"
#include "terrain/ground_summary.hpp"

namespace sandhopper {

inline constexpr std::int64_t kCyclePeriod_ns = 1'000'000;

// The topics of a trial's log, in the order they are written.
struct TrialTopics {
  explicit TrialTopics(TrialLogger& logger)
      : frame(logger.add_topic<SensorFrame>(topic::kFrame)),
        output(logger.add_topic<StepOutput>(topic::kOutput)),
        event(logger.add_topic<Event>(topic::kEvent)),
        stride(logger.add_topic<StrideResult>(topic::kStride, Lane::background)),
        profile(logger.add_topic<StrengthProfile>(topic::kProfile, Lane::background)),
        ground(logger.add_topic<GroundSummary>(topic::kGround, Lane::background)),
        ground_events(logger.add_topic<GroundEvents>(topic::kGroundEvents, Lane::background)) {}
  LogTopic<SensorFrame> frame;
  LogTopic<StepOutput> output;
  LogTopic<Event> event;
  LogTopic<StrideResult> stride;
  LogTopic<StrengthProfile> profile;
  LogTopic<GroundSummary> ground;
  LogTopic<GroundEvents> ground_events;
};

// Work outside the cycle: solves finished strides, logs them, and passes events and results to a listener.
// The cycle feeds it through rings. `serve` runs on a thread of ordinary priority (after start()) or is
// called directly (simulation).
class Aftermath {  // NOLINT(clang-analyzer-optin.performance.Padding): padding of the rings
 public:
  struct Listener {
    std::function<void(const Event&)> event{};
    std::function<void(const StrideResult&)> stride{};
    std::function<void(const StrengthProfile&, const GroundSummary&)> profile{};
    std::function<void(const GroundEvents&)> ground_events{};
    std::function<void(const RequestRecord&)> request{};
  };
  Aftermath(const StiffnessConfig& config, TrialLogger& logger, const TrialTopics& topics, Listener listener);
  ~Aftermath();

  void start();
  void stop();
  void serve();

  // Called by the cycle.
  void offer(const Event& event) noexcept { events_.push(event); }
  void offer(const StrideSums& sums) noexcept { strides_.push(sums); }
  // `clear_ns`: when the foot was clear of its crater, and the sums complete.
  void offer(const GroundEventSums& sums, std::int64_t clear_ns) noexcept {
    stances_.push({.sums = sums, .clear_ns = clear_ns});
  }
  void offer(const RequestRecord& answer) noexcept { answers_.push(answer); }

 private:
  struct Stance {
    GroundEventSums sums{};
    std::int64_t clear_ns = 0;
  };
  void serve(const StrideSums& sums);
  void serve(const Stance& stance);

  StiffnessConfig config_;
  ProfileSolver profile_;
  TrialLogger& logger_;
  const TrialTopics& topics_;
  Listener listener_;
  SpscRing<Event> events_{1024};
  SpscRing<StrideSums> strides_{64};
  SpscRing<Stance> stances_{16};
  SpscRing<RequestRecord> answers_{2048};
  std::thread thread_;
  std::atomic<bool> stopping_{false};
};

// One turn of the cycle: read, step, write, log. Every step is bounded, waits for nothing and allocates
// nothing.
class Cycle {
 public:
  struct Parts {
    Board& board;
    Controller& controller;
    TrialLogger& logger;
    const TrialTopics& topics;
    Aftermath& aftermath;
    FreezeRing* freeze = nullptr;  // the last seconds in shared memory; may be null
  };
  explicit Cycle(const Parts& parts) noexcept : parts_(parts) {}

  struct Turn {
    std::int64_t time_ns;
    std::uint64_t cycle;
    std::uint32_t overruns = 0;
    std::int64_t watchdog_stall_ns = 0;
    std::int64_t wall_clock_step_ns = 0;
    Request request = Request::none;
  };
  const StepOutput& run(const Turn& turn) noexcept;
  // Sensor frame of the last turn.
  const SensorFrame& frame() const noexcept { return frame_; }

 private:
  Parts parts_;
  SensorFrame frame_{};
};

}  // namespace sandhopper
