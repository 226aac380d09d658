#include "tools/faults/run_pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/supervision/findings.hpp"
#include "tools/faults/evidence.hpp"
#include "tools/faults/trial_rig.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::uint64_t kLongestPair_cycles = 9000;
constexpr std::uint64_t kWatched_cycles = 600;  // watching time for a fault that cannot be detected
constexpr std::uint64_t kQuiet_cycles = 30;     // watching time for drives that are off; longer than their
                                                // timeout

// One of the two faults. Times are counts of cycles that ran (TrialRig::turns()), 0: not yet. set_at:
// planted; shown_at: its cell calls it visible; visible_at: there is evidence as well.
struct Planted {
  explicit Planted(const Cell& of) : cell(of), evidence(of) {}
  Cell cell;  // a copy, because `visible` may keep state
  Evidence evidence;
  Injected before{};
  std::uint64_t set_at = 0, shown_at = 0, visible_at = 0;

  bool is_limit() const { return cell.kind == Kind::limit; }
  void see(const TrialRig& rig, const RobotConfig& robot) {
    if (visible_at != 0 || (set_at == 0 && !is_limit()) || rig.turns() < set_at) return;
    if (shown_at == 0 && (!cell.visible || cell.visible(rig.frame(), rig.output(), before)))
      shown_at = rig.turns();
    evidence.see(rig.frame(), before.frame, rig.output(), robot);
    if (shown_at != 0 && evidence.complete())
      visible_at =
          std::max(shown_at, rig.turns() - static_cast<std::uint64_t>(std::max(0, evidence.cycles_shown())));
  }
  // The fault must be raised up to this cycle.
  std::uint64_t deadline() const {
    const auto allowed = static_cast<std::uint64_t>(entry_of(cell.expected).cycles);
    return visible_at != 0 ? visible_at + allowed : set_at + kWatched_cycles;
  }
};

// Defects that no longer exist when the next session begins.
bool is_over_at_once(const Cell& cell) {
  switch (cell.kind) {
    case Kind::tapped:
    case Kind::stalled:
    case Kind::watchdog:
    case Kind::passive:
    case Kind::no_acknowledge:
    case Kind::overflow:
    case Kind::protocol_error:
    case Kind::limit:  // a sound robot, which need not exceed it again
      return true;
    default:
      return false;
  }
}

// Reason why a new session cannot detect the defect; empty: the new session must find it.
std::string lost_with_a_restart(const Cell& cell) {
  if (cell.kind == Kind::biased || (cell.device == Device::load_cell && cell.kind == Kind::wrong))
    return "an offset that is there before arming is taken for zero";
  if (cell.device == Device::load_cell && cell.kind == Kind::stuck)
    return "its noise was never seen, and its constant value is taken for zero";
  return {};
}

class PairTrial {
 public:
  PairTrial(const Pair& pair, const MatrixSetup& setup, const RobotConfig& robot)
      : pair_(pair),
        robot_(robot),
        rig_(setup, robot, pair.first.phase, setup.folder / "pair.mcap"),
        first_(pair.first),
        second_(pair.second) {}

  PairResult run(Fault first_alone, Fault second_alone) {
    result_.first_alone = first_alone;
    result_.second_alone = second_alone;
    while (rig_.turns() < kLongestPair_cycles && !over()) turn();
    finish();
    return result_;
  }

 private:
  void wrong(std::string text) {
    if (result_.problem.empty()) result_.problem = std::move(text);
  }

  bool over() const {
    if (!refusal_.empty()) return true;
    if (second_.set_at == 0) return false;
    const auto watched = std::max({first_.deadline(), second_.deadline(), second_.set_at + kQuiet_cycles});
    if (rig_.turns() <= watched) return ended_;
    return ended_ || (off_cycles_ > kQuiet_cycles && rig_.output().state == State::fault);
  }

  void turn() {
    rig_.turn();
    for (const auto& event : rig_.events()) see(event);
    first_.see(rig_, robot_);
    second_.see(rig_, robot_);
    see_command();
    plant();
  }

  void see(const Event& event) {
    events_.push_back(event);
    if (event.kind == EventKind::fault_raised) {
      if (!result_.raised.empty() && !is_harsher(event.fault, result_.raised.back()))
        wrong(fmt::format("{} took the place of {}", name_of(event.fault), name_of(result_.raised.back())));
      result_.raised.push_back(event.fault);
      raised_at_.push_back(rig_.turns());
    }
    if (event.kind == EventKind::armed) armed_ = true;
    if (event.kind == EventKind::stopped || event.kind == EventKind::arming_refused)
      ended_ = second_.set_at != 0;
    if (event.kind == EventKind::arming_refused)
      refusal_ = fmt::format("arming refused: {}", name_of(event.reason));
  }

  // In state `fault` no torque may be commanded; the drives' own damping is allowed. In a limp fault the
  // drives must be off.
  void see_command() {
    const auto& output = rig_.output();
    const bool off = output.command.drive == DriveRequest::off;
    off_cycles_ = off ? off_cycles_ + 1 : 0;
    if (output.state != State::fault) return;
    if (output.fault == Fault::none) wrong("state fault without a fault");
    if (entry_of(output.fault).reaction == Reaction::limp && !off) wrong("drives on after a limp fault");
    for (const auto& motor : output.command.motor)
      if (motor.torque_Nm != 0.0) wrong("a torque was commanded in state fault");
  }

  void plant() {
    if (first_.set_at == 0 && !first_.is_limit() && rig_.ready_to_break()) {
      set(first_);
      if (pair_.delay_cycles == kTogether) set(second_);
    }
    if (second_.set_at != 0) return;
    const bool raises = pair_.first.expected != Fault::none;
    const auto begin = !raises ? first_.set_at : raised_at_.empty() ? 0 : raised_at_.front();
    if (begin == 0 || rig_.turns() + 1 < begin + static_cast<std::uint64_t>(pair_.delay_cycles)) return;
    set(second_);
  }

  void set(Planted& fault) {
    fault.before.frame = rig_.frame();
    if (fault.cell.kind == Kind::restart) return restart();
    fault.set_at = rig_.turns() + 1;
    rig_.set(fault.cell.device, fault.cell.kind);
  }

  // Judges the log of the first session and starts the second one, which is judged alone. The defect stays.
  void restart() {
    see_log();
    first_raised_ = result_.raised;
    result_.raised.clear();
    raised_at_.clear();
    events_.clear();
    armed_ = false;
    rig_.board().bus().reset_torque();
    if (const auto refusal = rig_.restart(Phase::extension)) refusal_ = "start refused: " + *refusal;
    second_.set_at = 1;  // first cycle of the new session
  }

  void finish();
  void see_log();
  void judge_end();
  void judge_restart();
  void judge_harshness();
  bool note_hidden(const Planted& fault);
  void judge_times();
  void judge_drives();
  bool covers(Fault alone) const { return alone == Fault::none || !is_harsher(alone, result_.together); }

  const Pair& pair_;
  const RobotConfig& robot_;
  TrialRig rig_;
  Planted first_, second_;
  PairResult result_;
  std::vector<Event> events_;
  std::vector<std::uint64_t> raised_at_;
  std::vector<Fault> first_raised_;  // faults of the session before the restart
  std::uint64_t off_cycles_ = 0;
  std::string refusal_;
  bool armed_ = false;
  bool ended_ = false;
};

void PairTrial::finish() {
  result_.state = rig_.output().state;
  result_.together = rig_.output().fault;
  result_.time_s = rig_.time_s();
  result_.end = refusal_.empty() ? std::string(name_of(result_.state)) : refusal_;
  if (second_.set_at == 0) return wrong("the second fault's moment was not reached");
  if (pair_.second.kind == Kind::restart)
    judge_restart();
  else
    judge_end();
  judge_drives();
  see_log();
  result_.raised.insert(result_.raised.begin(), first_raised_.begin(), first_raised_.end());
}

void PairTrial::judge_end() {
  if (result_.first_alone == Fault::none && result_.second_alone == Fault::none) {
    if (result_.together != Fault::none) wrong("a fault where neither raises one");
    return;
  }
  if (result_.together == Fault::none) return wrong("silent");
  if (result_.state != State::fault) wrong(fmt::format("ended in state {}", name_of(result_.state)));
  judge_harshness();
  judge_times();
}

// Returns true and notes the reason if the fault never showed enough evidence to be found.
bool PairTrial::note_hidden(const Planted& fault) {
  if (fault.visible_at != 0) return false;
  result_.hidden = fault.evidence.wanted();
  return true;
}

void PairTrial::judge_harshness() {
  if (!covers(result_.first_alone) && !note_hidden(first_))
    wrong(fmt::format("ended in {}, alone the first ends in {}", name_of(result_.together),
                      name_of(result_.first_alone)));
  if (!covers(result_.second_alone) && !note_hidden(second_))
    wrong(fmt::format("ended in {}, alone the second ends in {}", name_of(result_.together),
                      name_of(result_.second_alone)));
}

// Checks the allowed number of cycles: of the first fault unless both were planted together, of the second
// fault if it was raised.
void PairTrial::judge_times() {
  const auto late = [&](const Planted& fault, std::size_t raised) {
    const auto found = result_.raised[raised];
    // A fault that is found before all its signs are visible is not late.
    const int cycles =
        fault.visible_at == 0 ? 0 : static_cast<int>(raised_at_[raised]) - static_cast<int>(fault.visible_at);
    if (cycles > entry_of(found).cycles)
      wrong(
          fmt::format("{} after {} cycles, allowed are {}", name_of(found), cycles, entry_of(found).cycles));
    return cycles;
  };
  if (result_.raised.empty()) return;
  if (pair_.delay_cycles != kTogether && pair_.first.expected != Fault::none) {
    if (!pair_.first.names(result_.raised.front()))
      wrong(fmt::format("the first was found as {}", name_of(result_.raised.front())));
    late(first_, 0);
  }
  for (std::size_t i = 0; i < result_.raised.size(); ++i)
    if (pair_.second.names(result_.raised[i]) && raised_at_[i] >= second_.set_at)
      result_.cycles = late(second_, i);
}

// Before it arms, the new session may command at most the small torque that tests the drives. Once it arms
// and hops it must find the fault.
void PairTrial::judge_restart() {
  const double tried_Nm = robot_.arming.confirm_torque_Nm + kNoTorque_Nm;
  if (!armed_ && rig_.board().bus().most_torque_Nm() > tried_Nm)
    wrong("torque before the new session was armed");
  if (!refusal_.empty()) return;
  if (result_.together != Fault::none) return;
  if (!ended_)
    wrong(fmt::format("without a fault the new session stayed in state {}", name_of(result_.state)));
  if (is_over_at_once(pair_.first)) return;
  result_.hidden = lost_with_a_restart(pair_.first);
  if (result_.hidden.empty()) wrong("silent after the restart");
}

void PairTrial::judge_drives() {
  if (refusal_.empty() && result_.together == Fault::none) return;
  for (const auto side : {Side::left, Side::right}) {
    const auto& command = rig_.board().bus().command(side);
    const double gains = command.kp_Nm_per_rad + command.kd_Nm_s_per_rad;
    if (std::abs(command.torque_Nm) > kNoTorque_Nm || gains > 0.01)
      wrong(fmt::format("the {} drive was left with {:.2f} N m, kp {:.1f}, kd {:.2f}",
                        side == Side::left ? "left" : "right", command.torque_Nm, command.kp_Nm_per_rad,
                        command.kd_Nm_s_per_rad));
  }
}

// Every event and every step of the date must be in the log. With a full disk the logger must report the
// error instead.
void PairTrial::see_log() {
  const auto trouble = rig_.close_log();
  const bool disk_full = pair_.first.kind == Kind::disk_full || pair_.second.kind == Kind::disk_full;
  if (disk_full != !trouble.empty()) wrong("the log's trouble: '" + trouble + "'");
  if (disk_full) return;
  const auto logged = events_in(rig_.log());
  for (const auto& event : events_)
    if (std::ranges::none_of(logged, [&](const Event& found) {
          return found.kind == event.kind && found.time_ns == event.time_ns && found.fault == event.fault;
        }))
      wrong(fmt::format("not in the log: {}", name_of(event.kind)));
  const bool clock = pair_.first.kind == Kind::clock_step || pair_.second.kind == Kind::clock_step;
  if (clock &&
      std::ranges::none_of(logged, [](const Event& e) { return e.kind == EventKind::clock_stepped; }))
    wrong("the step of the date is not in the log");
}

}  // namespace

Fault PairRunner::alone(const Cell& cell) {
  if (cell.expected == Fault::none && cell.device == Device::computer) return Fault::none;
  const auto key = fmt::format("{} {}", cell.name(), name_of(cell.phase));
  const auto known = alone_.find(key);
  if (known != alone_.end()) return known->second;
  auto complete = setup_;
  complete.without.reset();
  return alone_[key] = run_cell(cell, complete).at_end;
}

PairResult PairRunner::run(const Pair& pair) {
  RobotConfig robot = setup_.robot;
  for (const auto* cell : {&pair.first, &pair.second})
    if (cell->change) cell->change(robot);
  return PairTrial(pair, setup_, robot).run(alone(pair.first), alone(pair.second));
}

}  // namespace sandhopper::faults
