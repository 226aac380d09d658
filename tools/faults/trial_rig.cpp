#include "tools/faults/trial_rig.hpp"

#include <cerrno>
#include <stdexcept>

#include "drivers/device_error.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::uint64_t kArm_cycle = 300;   // when arming is requested; by then the noise of the sensors is
                                            // known
constexpr std::uint64_t kHang_cycles = 50;  // from arming to release
constexpr std::uint64_t kStall_cycles = 50;
constexpr std::int64_t kClockStep_ns = 3'600'000'000'000;  // one hour

std::uint64_t cycles_into(Phase phase) {
  switch (phase) {
    case Phase::idle:
      return 250;
    case Phase::armed:
    case Phase::flight:
      return 20;
    default:
      return 8;
  }
}

bool in_phase(Phase phase, const StepOutput& output, bool ready) {
  switch (phase) {
    case Phase::idle:
      return output.state == State::idle;
    case Phase::armed:
      return output.state == State::armed && ready;
    case Phase::flight:
      return output.state == State::flight;
    case Phase::compression:
      return output.state == State::compression;
    case Phase::extension:
      return output.state == State::extension;
  }
  return false;
}

TrialLogOptions log_options(const std::filesystem::path& log, FileCalls calls) {
  TrialLogOptions options;
  options.mcap_file = log;
  options.own_thread = false;
  options.mcap.calls = std::move(calls);
  return options;
}

}  // namespace

// The objects that a restart of hopperd creates anew.
struct TrialRig::Session {  // NOLINT(clang-analyzer-optin.performance.Padding): the rings' own
  Session(TrialLogOptions options, const RobotConfig& robot, Board& board, FreezeRing* freeze)
      : logger(std::move(options)),
        topics(logger),
        controller(cycle_config(robot)),
        aftermath(robot.stiffness, logger, topics, {}),
        cycle({board, controller, logger, topics, aftermath, freeze}) {
    logger.start();
  }
  TrialLogger logger;
  TrialTopics topics;
  Controller controller;
  Aftermath aftermath;
  Cycle cycle;
};

TrialRig::TrialRig(const MatrixSetup& setup, const RobotConfig& robot, Phase phase, std::filesystem::path log)
    : setup_(setup),
      robot_(robot),
      phase_(phase),
      log_(std::move(log)),
      world_(setup.world, {.seed = setup.seed}, 0),
      board_(world_, robot, setup.seed) {
  std::filesystem::remove(log_);
  begin_session();
}

TrialRig::~TrialRig() {
  session_.reset();
  std::error_code ignored;
  std::filesystem::remove(log_, ignored);
}

void TrialRig::begin_session() {
  session_ = std::make_unique<Session>(log_options(log_, file_calls()), robot_, board_,
                                       setup_.freeze ? setup_.freeze(robot_) : nullptr);
  if (setup_.without) session_->controller.switch_off(*setup_.without);
}

double TrialRig::time_s() const { return 1e-9 * static_cast<double>(world_.now_ns()); }
const SensorFrame& TrialRig::frame() const { return session_->cycle.frame(); }
std::span<const Event> TrialRig::events() const { return session_->controller.events(); }

void TrialRig::turn(Request asked) {
  cycle_number_ += missed_cycles() + 1;
  ++turns_;
  output_ =
      session_->cycle.run({.time_ns = origin_ns_ + static_cast<std::int64_t>(cycle_number_) * kCyclePeriod_ns,
                           .cycle = cycle_number_,
                           .overruns = overruns_,
                           .watchdog_stall_ns = watchdog_trips_ ? 25 * kCyclePeriod_ns : 0,
                           .wall_clock_step_ns = clock_steps_ ? kClockStep_ns : 0,
                           .request = asked == Request::none ? request() : asked});
  watchdog_trips_ = clock_steps_ = false;
  session_->aftermath.serve();
  for (const auto& event : events()) {
    if (event.kind != EventKind::armed) continue;
    armed_at_ = cycle_number_;
    ready_ = true;
  }
  in_phase_cycles_ = in_phase(phase_, output_, ready_) ? in_phase_cycles_ + 1 : 0;
}

bool TrialRig::ready_to_break() const { return in_phase_cycles_ == cycles_into(phase_); }

std::uint64_t TrialRig::missed_cycles() {
  const std::uint64_t missed = stalls_ ? kStall_cycles : overrunning_ ? 1 : 0;
  stalls_ = false;
  overruns_ += static_cast<std::uint32_t>(missed);
  return missed;
}

Request TrialRig::request() const {
  if (phase_ == Phase::idle) return Request::none;
  if (cycle_number_ == kArm_cycle) return Request::arm;
  const bool release = armed_at_ != 0 && phase_ != Phase::armed && cycle_number_ == armed_at_ + kHang_cycles;
  return release ? Request::release : Request::none;
}

std::uint64_t TrialRig::set(Device device, Kind kind) {
  board_.set(device, kind);
  if (device != Device::computer) return cycle_number_ + 1;
  if (kind == Kind::stalled) stalls_ = true;
  if (kind == Kind::overruns) overrunning_ = true;
  if (kind == Kind::watchdog) watchdog_trips_ = true;
  if (kind == Kind::clock_step) clock_steps_ = true;
  if (kind == Kind::disk_full) disk_full_ = true;
  return cycle_number_ + 1 + (stalls_ ? kStall_cycles : 0);
}

std::optional<std::string> TrialRig::restart(Phase phase) {
  phase_ = phase;
  session_.reset();
  std::filesystem::remove(log_);
  std::optional<std::string> refusal;
  try {
    board_.restart_driver();
  } catch (const DeviceError& error) {
    refusal = error.what();
  }
  begin_session();
  origin_ns_ = world_.now_ns() / kCyclePeriod_ns * kCyclePeriod_ns;
  cycle_number_ = turns_ = armed_at_ = in_phase_cycles_ = 0;
  overruns_ = 0;
  ready_ = false;
  return refusal;
}

std::string TrialRig::close_log() {
  session_->logger.stop();
  try {
    session_->logger.close();
  } catch (const std::exception& error) {
    return error.what();
  }
  return session_->logger.error();
}

// File calls of the trial's disk. They fail with ENOSPC once disk_full_ is set.
FileCalls TrialRig::file_calls() {
  const auto system = FileCalls::of_the_system();
  const auto full = [] {
    errno = ENOSPC;
    return -1;
  };
  return {
      .write = [this, system, full](int descriptor, std::span<const std::byte> data) -> ssize_t {
        return disk_full_ ? full() : system.write(descriptor, data);
      },
      .allocate =
          [this, system, full](int descriptor, off_t start, off_t length) {
            return disk_full_ ? full() : system.allocate(descriptor, start, length);
          },
      .sync = [this, system, full](int descriptor) { return disk_full_ ? full() : system.sync(descriptor); }};
}

std::vector<Event> events_in(const std::filesystem::path& log) {
  std::vector<Event> found;
  try {
    mcap::Reader reader(log);
    TopicOf<Event> events(topic::kEvent);
    mcap::Message message;
    Event event;
    while (reader.next(message))
      if (events.take(message, event)) found.push_back(event);
  } catch (const std::exception&) {
    return {};
  }
  return found;
}

}  // namespace sandhopper::faults
