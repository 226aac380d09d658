#include "tools/faults/run_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/dump.hpp"
#include "firmware/fault_check.hpp"
#include "tools/faults/trial_rig.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::uint64_t kLongest_cycles = 8000;
constexpr std::uint64_t kUnseen_cycles = 600;   // watching time for a fault that cannot be detected
constexpr std::uint64_t kAfter_cycles = 20;     // watching time for the reaction
constexpr std::uint64_t kFrozen_cycles = 1010;  // watching time for a freeze frame, which shows the second
                                                // after the fault
constexpr std::uint64_t kSoft_cycles = 3000;    // watching time for a soft stop
constexpr int kZeroWithin_cycles = 2;           // after this no torque may be commanded, but in a soft stop
constexpr double kLimpTorque_Nm = 1e-9;

class CellTrial {
 public:
  CellTrial(const Cell& cell, const MatrixSetup& setup, const RobotConfig& robot)
      : cell_(cell),
        robot_(to_node(robot)),
        rig_(setup, robot, cell.phase, setup.folder / "cell.mcap"),
        is_frozen_(setup.freeze != nullptr) {}

  CellResult run() {
    while (rig_.cycle() < kLongest_cycles && !over()) turn();
    rig_.close_log();
    result_.state = rig_.output().state;
    result_.at_end = rig_.output().fault;
    result_.time_s = rig_.time_s();
    judge();
    if (cell_.expected != Fault::none) see_log();
    return result_;
  }

 private:
  std::uint64_t after_cycles() const {
    if (entry_of(cell_.expected).reaction == Reaction::stop) return kSoft_cycles;
    return is_frozen_ ? kFrozen_cycles : kAfter_cycles;
  }
  bool over() const {
    if (ended_) return true;
    if (found_at_ != 0) return rig_.cycle() > found_at_ + after_cycles();
    // A fault that cannot be detected is watched for kUnseen_cycles. Without an injection the trial runs to
    // its end.
    return cell_.expected == Fault::none && cell_.kind != Kind::limit && injected_at_ != 0 &&
           rig_.cycle() > injected_at_ + kUnseen_cycles;
  }

  void turn() {
    rig_.turn();
    for (const auto& event : rig_.events()) see(event);
    see_reaction();
    // Faults are planted between two cycles.
    if (injected_at_ == 0 && rig_.ready_to_break()) inject();
  }

  void inject() {
    injected_.frame = rig_.frame();
    injected_at_ = cell_.kind == Kind::limit ? rig_.cycle() + 1 : rig_.set(cell_.device, cell_.kind);
  }

  void see(const Event& event) {
    if (event.kind == EventKind::stopped && cell_.expected == Fault::none) ended_ = true;
    if (event.kind != EventKind::fault_raised || found_at_ != 0) return;
    found_at_ = rig_.cycle();
    result_.found = event.fault;
    result_.message = in_words(read_fault(event, &robot_));
  }

  // A limit is in force from the start; any other fault can be seen from its injection on.
  void see_visible() {
    if (visible_at_ != 0 || (injected_at_ == 0 && cell_.kind != Kind::limit)) return;
    if (cell_.kind != Kind::limit && rig_.cycle() < injected_at_) return;
    if (!cell_.visible || cell_.visible(rig_.frame(), rig_.output(), injected_)) visible_at_ = rig_.cycle();
  }

  void see_reaction() {
    see_visible();
    if (found_at_ == 0) return;
    const auto& command = rig_.output().command;
    const auto since = static_cast<int>(rig_.cycle() - found_at_);
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

  void see_log() {
    const auto events = events_in(rig_.log());
    result_.logged = std::ranges::any_of(events, [&](const Event& event) {
      return event.kind == EventKind::fault_raised && event.fault == result_.found;
    });
    if (!result_.logged && result_.problem.empty()) result_.problem = "not in the log";
  }

  const Cell& cell_;
  ConfigNode robot_;
  TrialRig rig_;
  bool is_frozen_;
  Injected injected_;
  CellResult result_;
  std::uint64_t injected_at_ = 0, visible_at_ = 0, found_at_ = 0;
  bool ended_ = false;
  int turns_since_ = 0;
  bool limp_at_once_ = false;
  double most_torque_Nm_ = 0.0;
};

}  // namespace

CellResult run_cell(const Cell& cell, const MatrixSetup& setup) {
  RobotConfig robot = setup.robot;
  if (cell.change) cell.change(robot);
  return CellTrial(cell, setup, robot).run();
}

}  // namespace sandhopper::faults
