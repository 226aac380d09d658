#include "tests/transmit_guard/planted_defects.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "config/files.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::uint64_t kLongest_cycles = 4000;
constexpr std::uint64_t kAfter_cycles = 60;

// Applies the defect to each frame. If the defect begins several cycles, the frames of the last cycle are
// sent again after each begin.
class DefectivePort final : public ForwardingPort {
 public:
  DefectivePort(std::unique_ptr<CanPort> port, const Defect& defect)
      : ForwardingPort(std::move(port)), defect_(defect) {}

  void begin_cycle() noexcept override {
    for (int i = 1; i < defect_.begin_cycles; ++i) {
      ForwardingPort::begin_cycle();
      for (const auto& frame : last_) ForwardingPort::send(frame);
    }
    last_.clear();
    ForwardingPort::begin_cycle();
  }
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override {
    last_.push_back(frame);
    if (!defect_.frames) return ForwardingPort::send(frame);
    std::optional<std::int64_t> sent;
    defect_.frames(frame, [&](const can_frame& out) { sent = ForwardingPort::send(out); });
    return sent;
  }

 private:
  const Defect& defect_;
  std::vector<can_frame> last_;
};

struct Caught {
  RefusedFrames refused;
  WireRecord wire;
  Fault fault = Fault::none;
  int cycles = -1;               // from the first refusal to the fault
  double later_torque_Nm = 0.0;  // largest torque commanded to a drive after the fault
  bool disarmed = false;
  bool hopped = false;
};

class Trial {
 public:
  Trial(const Defect& defect, const RobotConfig& robot)
      : defect_(defect),
        bench_(robot, 1,
               {.command = [this](const auto& o, auto& c, auto& f) { alter(o, c, f); },
                .driver =
                    [&defect](std::unique_ptr<CanPort> port) {
                      return std::make_unique<DefectivePort>(std::move(port), defect);
                    }}) {}

  Caught run() {
    Caught out;
    std::uint64_t refused_at = 0, fault_at = 0;
    Request request = Request::none;
    while (bench_.cycles() < kLongest_cycles &&
           (fault_at == 0 || bench_.cycles() < fault_at + kAfter_cycles)) {
      const auto& output = bench_.turn(bench_.cycles() == 100 ? Request::arm : request);
      request = fault_at != 0 ? Request::disarm : Request::none;
      for (const auto& event : bench_.controller().events())
        if (event.kind == EventKind::armed && defect_.occasion != Occasion::hold_fault)
          request = Request::release;
      out.hopped = out.hopped || output.state == State::compression;
      happen(output);
      if (refused_at == 0 && bench_.refused().count > 0) refused_at = bench_.cycles();
      // An earlier fault that is as harsh may stay; disarming does not clear it.
      if (fault_at == 0 && refused_at != 0 && entry_of(output.fault).reaction == Reaction::limp) {
        fault_at = bench_.cycles();
        out.cycles = static_cast<int>(fault_at - refused_at);
        bench_.board().bus().reset_torque();
      }
      out.fault = output.fault;
      if (fault_at != 0) out.disarmed = out.disarmed || output.state == State::armed;
    }
    out.later_torque_Nm = bench_.board().bus().most_torque_Nm();
    out.refused = bench_.refused();
    out.wire = bench_.wire();
    return out;
  }

 private:
  // Plants the occasion in the second half of a compression. A hold needs none, because it occurs by itself.
  void happen(const StepOutput& output) {
    const bool now = output.state == State::compression && ++compressing_ == 20;
    if (tapped_ && bench_.cycles() == tapped_at_ + 5) bench_.board().set(Device::estop, std::nullopt);
    if (!now) return;
    came_ = true;
    if (defect_.occasion == Occasion::stop_open) bench_.board().set(Device::estop, Kind::pressed);
    if (defect_.occasion == Occasion::limp_fault) bench_.board().set(Device::motor_left, Kind::error);
    if (defect_.occasion == Occasion::damp_fault) bench_.board().set(Device::motor_left, Kind::hot);
    if (defect_.occasion != Occasion::stop_tapped) return;
    bench_.board().set(Device::estop, Kind::pressed);
    tapped_ = true;
    tapped_at_ = bench_.cycles();
  }

  void alter(const StepOutput& output, Command& command, Fault& told) {
    if (!defect_.command) return;
    const bool faulty = output.fault != Fault::none && output.fault != Fault::transmit_refused;
    switch (defect_.occasion) {
      case Occasion::hop:
        if (output.state != State::compression) return;
        break;
      case Occasion::stop_tapped:  // no defect while the e-stop is open
        if (!tapped_ || bench_.frame().emergency_stop) return;
        break;
      default:
        if (!faulty) return;
    }
    if (output.fault != Fault::transmit_refused) defect_.command(output, command, told);
  }

  const Defect& defect_;
  GuardBench bench_;
  int compressing_ = 0;
  bool came_ = false, tapped_ = false;
  std::uint64_t tapped_at_ = 0;
};

RobotConfig robot_of(const Defect& defect) {
  auto robot = load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config");
  for (auto& motor : robot.motor) motor.dialect = defect.dialect;
  if (defect.occasion == Occasion::hold_fault) robot.supervision.foot_height_m = 0.03;
  return robot;
}

TEST(GuardDefects, EveryPlantedDefectIsCaughtAndEndsLimp) {
  int caught = 0;
  const auto defects = all_defects();
  for (const auto& defect : defects) {
    SCOPED_TRACE(defect.name);
    const auto robot = robot_of(defect);
    const auto out = Trial(defect, robot).run();
    caught += out.refused.count > 0 && out.wire.breach.empty();
    fmt::print("  {:62} {:14} {} frames refused, fault {} after {}\n", defect.name, name_of(out.refused.rule),
               out.refused.count, name_of(out.fault), out.cycles);
    EXPECT_GT(out.refused.count, 0U);
    EXPECT_EQ(out.wire.breach, "");
    EXPECT_LE(out.cycles, entry_of(Fault::transmit_refused).cycles);
    EXPECT_GE(out.cycles, 0) << "no fault";
    // An open e-stop is as harsh and may stay the reported fault.
    const bool stopped = defect.occasion == Occasion::stop_open && out.fault == Fault::emergency_stop;
    EXPECT_TRUE(stopped || out.fault == Fault::transmit_refused) << name_of(out.fault);
    EXPECT_LT(out.later_torque_Nm, 0.02);
    EXPECT_FALSE(out.disarmed) << "was armed again";
  }
  fmt::print("{} of {} planted defects caught\n", caught, defects.size());
  EXPECT_GE(defects.size(), 20U);
}

// With a sound controller and driver nothing may be refused on the same occasions.
TEST(GuardDefects, WithoutADefectNothingIsRefused) {
  for (const auto dialect : {Dialect::mit, Dialect::servo, Dialect::v3})
    for (const auto occasion : {Occasion::hop, Occasion::stop_tapped, Occasion::stop_open,
                                Occasion::limp_fault, Occasion::damp_fault, Occasion::hold_fault}) {
      const Defect none{.name = "none", .dialect = dialect, .occasion = occasion};
      const auto robot = robot_of(none);
      const auto out = Trial(none, robot).run();
      EXPECT_EQ(out.refused.count, 0U)
          << name_of(dialect) << " " << static_cast<int>(occasion) << " " << name_of(out.refused.rule);
      EXPECT_EQ(out.wire.breach, "");
      EXPECT_EQ(out.hopped, occasion != Occasion::hold_fault);
      EXPECT_GT(out.wire.torque_frames + out.wire.gain_frames, 100U);
    }
}

}  // namespace
}  // namespace sandhopper::faults
