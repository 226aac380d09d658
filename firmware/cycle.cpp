#include "firmware/cycle.hpp"

#include <ctime>
#include <utility>

namespace sandhopper {

const StepOutput& Cycle::run(const Turn& turn) noexcept {
  frame_.time_ns = turn.time_ns;
  frame_.cycle = turn.cycle;
  frame_.overruns = turn.overruns;
  frame_.watchdog_stall_ns = turn.watchdog_stall_ns;
  frame_.wall_clock_step_ns = turn.wall_clock_step_ns;
  frame_.request = turn.request;
  parts_.board.read(frame_);
  const StepOutput& output = parts_.controller.step(frame_);
  parts_.board.note_fault(output.fault);
  parts_.board.write(output.command);

  parts_.logger.push(parts_.topics.frame, turn.time_ns, frame_);
  parts_.logger.push(parts_.topics.output, turn.time_ns, output);
  for (const Event& event : parts_.controller.events()) {
    parts_.logger.push(parts_.topics.event, turn.time_ns, event);
    parts_.aftermath.offer(event);
  }
  if (parts_.freeze != nullptr) parts_.freeze->push(frame_, output, parts_.controller.events());
  if (parts_.controller.stride_finished()) parts_.aftermath.offer(parts_.controller.stride_sums());
  if (parts_.controller.ground_events_complete())
    parts_.aftermath.offer(parts_.controller.ground_event_sums(), turn.time_ns);
  return output;
}

Aftermath::Aftermath(const StiffnessConfig& config, TrialLogger& logger, const TrialTopics& topics,
                     Listener listener)
    : config_(config), profile_(config), logger_(logger), topics_(topics), listener_(std::move(listener)) {}

Aftermath::~Aftermath() { stop(); }

void Aftermath::start() {
  thread_ = std::thread([this] {
    while (!stopping_.load(std::memory_order_acquire)) {
      serve();
      const timespec pause{0, 5'000'000};
      clock_nanosleep(CLOCK_MONOTONIC, 0, &pause, nullptr);
    }
    serve();
  });
}

void Aftermath::stop() {
  stopping_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

void Aftermath::serve() {
  for (const Event* event = events_.front(); event != nullptr; event = events_.front()) {
    if (listener_.event) listener_.event(*event);
    events_.pop();
  }
  for (const RequestRecord* answer = answers_.front(); answer != nullptr; answer = answers_.front()) {
    if (listener_.request) listener_.request(*answer);
    answers_.pop();
  }
  // A stance is searched with the profile of the strides up to its own, in the order of time as in a replay.
  // The cycle offers a stride before its stance, and that before the next stride: a stance that was there has
  // its stride, and without one the next stride shows only after its stance.
  for (;;) {
    const Stance* stance = stances_.front();
    const StrideSums* sums = strides_.front();
    if (stance == nullptr) stance = stances_.front();
    if (sums != nullptr && (stance == nullptr || sums->summary.liftoff_ns <= stance->clear_ns)) {
      serve(*sums);
      strides_.pop();
    } else if (stance != nullptr) {
      serve(*stance);
      stances_.pop();
    } else {
      return;
    }
  }
}

void Aftermath::serve(const StrideSums& sums) {
  const StrideResult result = solve_stride(sums, config_);
  logger_.push(topics_.stride, sums.summary.liftoff_ns, result);
  if (listener_.stride) listener_.stride(result);
  profile_.add(sums.profile, sums.summary.stride);
  const GroundSummary ground = summarise(profile_);
  logger_.push(topics_.profile, sums.summary.liftoff_ns, profile_.profile());
  logger_.push(topics_.ground, sums.summary.liftoff_ns, ground);
  if (listener_.profile) listener_.profile(profile_.profile(), ground);
}

void Aftermath::serve(const Stance& stance) {
  const GroundEvents found =
      find_ground_events(stance.sums, ground_event_config(config_), profile_.profile());
  // The record's time is that of the cycle that completed it: a replay, which reads in the order of time,
  // has computed it by then.
  logger_.push(topics_.ground_events, stance.clear_ns, found);
  if (listener_.ground_events) listener_.ground_events(found);
}

}  // namespace sandhopper
