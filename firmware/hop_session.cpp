#include "firmware/hop_session.hpp"

#include <algorithm>
#include <utility>

#include "firmware/freeze/freeze_frame.hpp"

namespace sandhopper {
namespace {

// Cycles after the drives went off, so that their last commands are sent and logged.
constexpr std::uint64_t kTail_cycles = 20;
// Cycles after a fault, so that its freeze frame contains the second after it.
constexpr std::uint64_t kFrozen_cycles = kFreezeAfter_ns / kCyclePeriod_ns + 1;
// Longest wait for the robot to come to rest.
constexpr std::uint64_t kPatience_cycles = 15'000;

CycleConfig started_from(CycleConfig config, const StartState& start) {
  config.start = start;
  return config;
}

StateSample state_sample(const Controller& controller, const SensorFrame& frame, Fault fault) noexcept {
  StateSample sample;
  for (std::size_t i = 0; i < kMotorCount; ++i) {
    sample.winding_C[i] = controller.thermal(i).winding_C();
    sample.housing_C[i] = controller.thermal(i).housing_C();
    sample.position_rad[i] = frame.motor[i].time_ns == 0 ? kNotMeasured : frame.motor[i].position_rad;
  }
  sample.touchdowns = controller.touchdowns();
  sample.fault = fault;
  return sample;
}

}  // namespace

HopSession::HopSession(const RobotConfig& robot, Board& board, TrialLogger& logger,
                       Aftermath::Listener listener, const StartState& start)
    : robot_(robot),
      board_(board),
      logger_(logger),
      topics_(logger),
      request_topic_(logger.add_topic<RequestRecord>(topic::kRequest)),
      controller_(started_from(cycle_config(robot), start)),
      aftermath_(robot.stiffness, logger, topics_, std::move(listener)) {}

SessionResult HopSession::run(World world) {
  SessionResult result;
  logger_.start();
  aftermath_.start();
  Cycle cycle({board_, controller_, logger_, topics_, aftermath_, world.freeze});
  {
    const RealTimeThread real_time(robot_.real_time);
    for (const auto& warning : real_time.warnings()) world.say(warning);
    CycleClock clock(kCyclePeriod_ns, world.time);
    turn_until_quit(world, cycle, clock, result);
    world.heart.end();
    result.cycles = clock.cycle();
    result.overruns = clock.overruns();
    result.latency = clock.latency();
  }
  aftermath_.stop();
  logger_.stop();
  result.lost_records = logger_.lost_records();
  result.lost_can_frames = logger_.lost_can_frames();
  return result;
}

void HopSession::turn_until_quit(World& world, Cycle& cycle, CycleClock& clock, SessionResult& result) {
  std::uint64_t asked_to_quit = 0;
  std::uint64_t off_since = 0;
  std::uint64_t picture_done = 0;  // the cycle in which the last fault's freeze frame is complete
  while (true) {
    const std::int64_t now_ns = clock.wait();
    const auto taken = world.requests.take(now_ns, world.quit);
    const Quit quit = world.quit.load(std::memory_order_acquire);
    if (quit != Quit::no && asked_to_quit == 0) asked_to_quit = clock.cycle();
    const auto step_ns = world.wall_clock.step_ns();
    if (step_ns != 0) ++result.clock_steps;
    const auto& output = cycle.run({.time_ns = now_ns,
                                    .cycle = clock.cycle(),
                                    .overruns = clock.overruns(),
                                    .watchdog_stall_ns = world.heart.take_trip(),
                                    .wall_clock_step_ns = step_ns,
                                    .request = taken.request});
    world.heart.beat(output.state, output.fault);
    tell_answers(taken.answers, output);
    if (world.status != nullptr) world.status->publish(live_status(cycle.frame(), output, clock.latency()));
    if (world.state != nullptr) world.state->publish(state_sample(controller_, cycle.frame(), output.fault));
    const bool off = output.command.drive == DriveRequest::off;
    if (!off) off_since = clock.cycle();
    result.last_state = output.state;
    if (world.freeze != nullptr && output.fault != Fault::none && output.fault != result.last_fault)
      picture_done = clock.cycle() + kFrozen_cycles;
    result.last_fault = output.fault;
    if (asked_to_quit == 0) continue;
    const bool over = quit == Quit::at_once ||
                      (off && clock.cycle() > std::max({off_since + kTail_cycles,
                                                        asked_to_quit + kTail_cycles, picture_done})) ||
                      clock.cycle() > asked_to_quit + kPatience_cycles;
    if (!over) continue;
    answer_the_rest(world, now_ns, output);
    return;
  }
}

// A quit is always served, because it ends the session in every state.
void HopSession::tell_answers(std::span<RequestRecord> answers, const StepOutput& output) noexcept {
  for (auto& answer : answers) {
    answer.state = output.state;
    const bool idle_word = answer.outcome == RequestOutcome::served && !means_quit(answer.word);
    if (idle_word && !controller_.request_had_effect()) answer.outcome = RequestOutcome::no_effect;
    logger_.push(request_topic_, answer.time_ns, answer);
    aftermath_.offer(answer);
  }
}

// Answers the words that came during the last cycle. No cycle will serve them.
void HopSession::answer_the_rest(World& world, std::int64_t now_ns, const StepOutput& output) noexcept {
  for (auto taken = world.requests.take(now_ns, world.quit); !taken.answers.empty();
       taken = world.requests.take(now_ns, world.quit)) {
    for (auto& answer : taken.answers)
      if (answer.outcome == RequestOutcome::served && !means_quit(answer.word)) {
        answer.outcome = RequestOutcome::overruled;
        answer.overruled_by = Word::quit;
      }
    tell_answers(taken.answers, output);
  }
}

}  // namespace sandhopper
