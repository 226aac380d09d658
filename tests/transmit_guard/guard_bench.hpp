#pragma once
#include <functional>
#include <optional>

#include "firmware/controller.hpp"
#include "tests/transmit_guard/wire_oracle.hpp"
#include "tools/faults/bench_board.hpp"

namespace sandhopper::faults {

// Callbacks with which a test alters a cycle.
struct GuardBenchHooks {
  std::function<void(SensorFrame& frame)> sensors{};
  // Changes the command and the fault that the board gets. The oracle still knows the controller's own.
  std::function<void(const StepOutput& output, Command& command, Fault& told)> command{};
  BenchStages::Stage driver{};  // between driver and guard
};

// Controller, driver, guard and emulated drives, with an oracle at the wire.
class GuardBench {
 public:
  GuardBench(const RobotConfig& robot, std::uint64_t seed, GuardBenchHooks hooks = {})
      : robot_(robot),
        hooks_(std::move(hooks)),
        world_(WorldConfig{}, {.seed = seed}, 0),
        board_(world_, robot_, seed, stages()),
        controller_(cycle_config(robot_)) {}
  GuardBench(const GuardBench&) = delete;
  GuardBench& operator=(const GuardBench&) = delete;

  // Runs one cycle after `skipped` missed ones.
  const StepOutput& turn(Request request = Request::none, std::uint64_t skipped = 0) {
    cycle_ += 1 + skipped;
    frame_.time_ns = static_cast<std::int64_t>(cycle_) * 1'000'000;
    frame_.cycle = cycle_;
    frame_.overruns += static_cast<std::uint32_t>(skipped);
    frame_.request = request;
    board_.read(frame_);
    truth_.emergency_stop = frame_.emergency_stop;
    if (hooks_.sensors) hooks_.sensors(frame_);
    const auto& output = controller_.step(frame_);
    truth_.fault = output.fault;
    Command command = output.command;
    Fault told = output.fault;
    if (hooks_.command) hooks_.command(output, command, told);
    board_.note_fault(told);
    board_.write(command);
    return output;
  }

  BenchBoard& board() { return board_; }
  Controller& controller() { return controller_; }
  const SensorFrame& frame() const { return frame_; }
  const WireRecord& wire() const { return record_; }
  const RefusedFrames& refused() { return board_.guard().refused(); }
  std::uint64_t cycles() const { return cycle_; }

 private:
  BenchStages stages() {
    return {.before_guard = hooks_.driver, .behind_guard = [this](std::unique_ptr<CanPort> port) {
              return std::make_unique<WireOracle>(std::move(port), robot_, truth_, record_);
            }};
  }

  const RobotConfig robot_;
  GuardBenchHooks hooks_;
  Truth truth_;
  WireRecord record_;
  World world_;
  BenchBoard board_;
  Controller controller_;
  SensorFrame frame_{};
  std::uint64_t cycle_ = 0;
};

}  // namespace sandhopper::faults
