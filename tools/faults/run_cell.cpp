#include "tools/faults/run_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/cycle.hpp"
#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"
#include "tools/faults/bench_board.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::uint64_t kArm_cycle = 300;   // noise of the sensors is known by then
constexpr std::uint64_t kHang_cycles = 50;  // between armed and release
constexpr std::uint64_t kLongest_cycles = 8000;
constexpr std::uint64_t kUnseen_cycles = 600;   // of watching for what cannot be seen
constexpr std::uint64_t kAfter_cycles = 20;     // of watching the reaction
constexpr std::uint64_t kFrozen_cycles = 1010;  // of the second after a fault that a freeze frame shows
constexpr std::uint64_t kSoft_cycles = 3000;    // of watching a soft stop
constexpr int kZeroWithin_cycles = 2;           // limp: no torque commanded any more
constexpr std::uint64_t kStall_cycles = 50;
constexpr double kLimpTorque_Nm = 1e-9;

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

TrialLogOptions log_options(const std::filesystem::path& log) {
  TrialLogOptions options;
  options.mcap_file = log;
  options.own_thread = false;
  return options;
}

class CellTrial {
 public:
  CellTrial(const Cell& cell, const MatrixSetup& setup, const RobotConfig& robot,
            const std::filesystem::path& log)
      : cell_(cell),
        world_(setup.world, {.seed = setup.seed}, 0),
        board_(world_, robot, setup.seed),
        logger_(log_options(log)),
        topics_(logger_),
        controller_(cycle_config(robot)),
        aftermath_(robot.stiffness, logger_, topics_, {}),
        is_frozen_(setup.freeze != nullptr),
        cycle_(
            {board_, controller_, logger_, topics_, aftermath_, is_frozen_ ? setup.freeze(robot) : nullptr}) {
    if (setup.without) controller_.switch_off(*setup.without);
  }

  CellResult run() {
    logger_.start();
    while (cycle_number_ < kLongest_cycles && !over()) turn();
    logger_.stop();
    logger_.close();
    result_.state = output_->state;
    result_.at_end = output_->fault;
    result_.time_s = 1e-9 * static_cast<double>(output_->time_ns);
    judge();
    return result_;
  }

 private:
  std::uint64_t after_cycles() const {
    if (entry_of(cell_.expected).reaction == Reaction::stop) return kSoft_cycles;
    return is_frozen_ ? kFrozen_cycles : kAfter_cycles;
  }
  bool over() const {
    if (output_ != nullptr && ended_) return true;
    if (found_at_ != 0) return cycle_number_ > found_at_ + after_cycles();
    // A sound trial goes on to its own end.
    return cell_.expected == Fault::none && cell_.kind != Kind::limit && injected_at_ != 0 &&
           cycle_number_ > injected_at_ + kUnseen_cycles;
  }

  void turn() {
    cycle_number_ += skipped();
    const auto now_ns = static_cast<std::int64_t>(cycle_number_) * kCyclePeriod_ns;
    const bool tripped = cell_.kind == Kind::watchdog && injected_at_ != 0 && cycle_number_ == injected_at_;
    output_ = &cycle_.run({.time_ns = now_ns,
                           .cycle = cycle_number_,
                           .overruns = overruns_,
                           .watchdog_stall_ns = tripped ? 25 * kCyclePeriod_ns : 0,
                           .request = request()});
    aftermath_.serve();
    for (const auto& event : controller_.events()) see(event);
    see_reaction();
    const bool here = in_phase(cell_.phase, *output_, ready_);
    in_phase_cycles_ = here ? in_phase_cycles_ + 1 : 0;
    // Between this cycle and the next.
    if (injected_at_ == 0 && in_phase_cycles_ == cycles_into(cell_.phase)) inject();
  }

  std::uint64_t skipped() {
    std::uint64_t missed = 0;
    if (cell_.device == Device::computer && injected_at_ != 0) {
      if (cell_.kind == Kind::stalled && cycle_number_ + 1 == injected_at_) missed = kStall_cycles;
      if (cell_.kind == Kind::overruns) missed = 1;
    }
    overruns_ += static_cast<std::uint32_t>(missed);
    if (missed == kStall_cycles) injected_at_ += kStall_cycles;
    return missed + 1;
  }

  void inject() {
    injected_at_ = cycle_number_ + 1;  // the first cycle that reads it
    injected_.frame = cycle_.frame();
    if (cell_.kind != Kind::limit) board_.set(cell_.device, cell_.kind);
  }

  Request request() {
    if (cell_.phase == Phase::idle) return Request::none;
    if (cycle_number_ == kArm_cycle) return Request::arm;
    if (armed_at_ != 0 && cell_.phase != Phase::armed && cycle_number_ == armed_at_ + kHang_cycles)
      return Request::release;
    return Request::none;
  }

  void see(const Event& event) {
    if (event.kind == EventKind::stopped && cell_.expected == Fault::none) ended_ = true;
    if (event.kind == EventKind::armed) {
      armed_at_ = cycle_number_;
      ready_ = true;
    }
    if (event.kind != EventKind::fault_raised || found_at_ != 0) return;
    found_at_ = cycle_number_;
    result_.found = event.fault;
  }

  // A limit is in force from the start; anything else can be seen from its injection on.
  void see_visible() {
    if (visible_at_ != 0 || (injected_at_ == 0 && cell_.kind != Kind::limit)) return;
    if (cell_.kind != Kind::limit && cycle_number_ < injected_at_) return;
    if (!cell_.visible || cell_.visible(cycle_.frame(), *output_, injected_)) visible_at_ = cycle_number_;
  }

  void see_reaction() {
    see_visible();
    if (found_at_ == 0) return;
    const auto& command = output_->command;
    const auto since = static_cast<int>(cycle_number_ - found_at_);
    double torque = 0.0, kp = 0.0, kd = 0.0;
    for (const auto& motor : command.motor) {
      torque = std::max(torque, std::abs(motor.torque_Nm));
      kp = std::max(kp, motor.kp_Nm_per_rad);
      kd = std::max(kd, motor.kd_Nm_s_per_rad);
    }
    const bool off = command.drive == DriveRequest::off;
    if (since >= kZeroWithin_cycles) most_torque_Nm_ = std::max(most_torque_Nm_, torque);
    result_.torque = off ? "off" : fmt::format("{:.2f} N m, kp {:.1f}, kd {:.2f}", torque, kp, kd);
    if (turns_since_++ == 1) limp_at_once_ = off && torque < kLimpTorque_Nm && kp == 0.0 && kd == 0.0;
  }

  void judge() {
    const auto wrong = [&](std::string text) {
      if (result_.problem.empty()) result_.problem = std::move(text);
    };
    if (injected_at_ == 0 && cell_.kind != Kind::limit) wrong("the phase was not reached");
    if (!cell_.names(result_.found))
      wrong(fmt::format("expected {}, found {}", name_of(cell_.expected), name_of(result_.found)));
    if (cell_.expected == Fault::none || !cell_.names(result_.found)) return;
    result_.cycles =
        static_cast<int>(found_at_) - static_cast<int>(visible_at_ == 0 ? injected_at_ : visible_at_);
    const auto& entry = entry_of(result_.found);
    if (result_.cycles > entry.cycles)
      wrong(fmt::format("seen after {} cycles, allowed are {}", result_.cycles, entry.cycles));
    if (found_at_ < injected_at_ && cell_.kind != Kind::limit) wrong("raised before it was there");
    const bool latched = result_.state == State::fault && result_.at_end != Fault::none;
    if (!latched) wrong(fmt::format("ended in state {}", name_of(result_.state)));
    const bool acts = cell_.phase != Phase::idle && entry.reaction != Reaction::limp;
    if (!acts && !limp_at_once_) wrong("torque after the reaction: " + result_.torque);
    if (most_torque_Nm_ > kLimpTorque_Nm && entry.reaction != Reaction::stop)
      wrong(fmt::format("a torque of {:.2f} N m was commanded after the reaction", most_torque_Nm_));
  }

  const Cell& cell_;
  World world_;
  BenchBoard board_;
  TrialLogger logger_;
  TrialTopics topics_;
  Controller controller_;
  Aftermath aftermath_;
  bool is_frozen_;
  Cycle cycle_;
  Injected injected_;
  const StepOutput* output_ = nullptr;
  CellResult result_;
  std::uint64_t cycle_number_ = 0, injected_at_ = 0, visible_at_ = 0, found_at_ = 0, armed_at_ = 0;
  std::uint64_t in_phase_cycles_ = 0;
  std::uint32_t overruns_ = 0;
  bool ready_ = false;
  bool ended_ = false;
  int turns_since_ = 0;
  bool limp_at_once_ = false;
  double most_torque_Nm_ = 0.0;
};

bool is_logged(const std::filesystem::path& log, Fault fault) {
  mcap::Reader reader(log);
  TopicOf<Event> events(topic::kEvent);
  mcap::Message message;
  Event event;
  while (reader.next(message))
    if (events.take(message, event) && event.kind == EventKind::fault_raised && event.fault == fault)
      return true;
  return false;
}

}  // namespace

CellResult run_cell(const Cell& cell, const MatrixSetup& setup) {
  RobotConfig robot = setup.robot;
  if (cell.change) cell.change(robot);
  const auto log = setup.folder / "cell.mcap";
  std::filesystem::remove(log);
  auto result = CellTrial(cell, setup, robot, log).run();
  result.logged = cell.expected != Fault::none && is_logged(log, result.found);
  if (cell.expected != Fault::none && !result.logged && result.problem.empty())
    result.problem = "not in the log";
  std::filesystem::remove(log);
  return result;
}

}  // namespace sandhopper::faults
