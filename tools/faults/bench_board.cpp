#include "tools/faults/bench_board.hpp"

#include <utility>

#include "firmware/transmit_limits.hpp"

namespace sandhopper::faults {
namespace {

// Forwards to the bus. Each session owns and destroys its port; the bus outlives all sessions.
class SessionPort : public CanPort {
 public:
  explicit SessionPort(EmulatedBus& bus) : bus_(bus) {}
  void begin_cycle() noexcept override { bus_.begin_cycle(); }
  std::optional<std::int64_t> send(const can_frame& frame) noexcept override { return bus_.send(frame); }
  std::span<const ReceivedFrame> receive(bool& more) noexcept override { return bus_.receive(more); }
  bool settled() const noexcept override { return bus_.settled(); }
  void pause(std::int64_t duration_ns) noexcept override { bus_.pause(duration_ns); }
  bool wait(std::int64_t timeout_ns) noexcept override { return bus_.wait(timeout_ns); }
  const CanCounters& counters() const noexcept override { return bus_.counters(); }
  void set_tap(CanTap* tap) noexcept override { bus_.set_tap(tap); }

 private:
  EmulatedBus& bus_;
};

}  // namespace

CanConfig can_of(const RobotConfig& robot) {
  CanConfig can;
  can.motor = robot.motor;
  can.motor_torque_Nm = robot.limits.motor_torque_Nm;
  can.motor_count = robot.robot.motor_count;
  return can;
}

BenchBoard::BenchBoard(World& world, const RobotConfig& robot, std::uint64_t seed, const BenchStages& stages)
    : world_(world),
      can_(can_of(robot)),
      limits_(transmit_limits(can_, robot.limits)),
      stages_(stages),
      bus_(std::make_unique<EmulatedBus>(world, can_, seed)),
      drives_(make_driver()),
      imu_body_(seed + 1),
      imu_foot_(seed + 2),
      tof_(seed + 3),
      load_cell_(seed + 4) {}

std::unique_ptr<CubeMarsDrives> BenchBoard::make_driver() {
  const auto pass = [](const BenchStages::Stage& stage, std::unique_ptr<CanPort> port) {
    return stage ? stage(std::move(port)) : std::move(port);
  };
  auto guard = std::make_unique<GuardedPort>(pass(stages_.behind_guard, std::make_unique<SessionPort>(*bus_)),
                                             limits_);
  guard_ = guard.get();
  auto miscoding = std::make_unique<MiscodingPort>(std::move(guard));
  miscoding_ = miscoding.get();
  miscoding_->set(is_miscoded_);
  return std::make_unique<CubeMarsDrives>(can_, pass(stages_.before_guard, std::move(miscoding)));
}

void BenchBoard::restart_driver() {
  drives_.reset();
  bus_->reopen();
  drives_ = make_driver();
  drives_->probe();
}

void BenchBoard::read(SensorFrame& frame) noexcept {
  world_.advance_to(frame.time_ns);
  bus_->advance();
  for (auto& motor : frame.motor) motor.fresh = false;
  drives_->drain([&](const MotorReading& reading) {
    frame.motor[static_cast<std::size_t>(reading.side)] = reading.sample;
  });
  imu_body_.pass(world_.imu_body(), frame.time_ns, frame.imu_body);
  imu_foot_.pass(world_.imu_foot(), frame.time_ns, frame.imu_foot);
  tof_.pass(world_.tof(), frame.time_ns, frame.tof);
  load_cell_.pass(world_.load_cell(), frame.time_ns, frame.load_cell);
  frame.bus = drives_->bus_sample();
  frame.bus.refused = guard_->refused();
  frame.emergency_stop = emergency_stop_ = stop_level_ || stop_edge_;
  stop_edge_ = false;
}

void BenchBoard::write(const Command& command) noexcept {
  guard_->begin(
      {.now_ns = world_.now_ns(), .allowance = allowance_of(latched_), .emergency_stop = emergency_stop_});
  drives_->command(command.motor, command.drive, world_.now_ns());
  if (command.open_catch) world_.open_catch();
}

void BenchBoard::set(Device device, std::optional<Kind> kind) {
  const auto now_ns = world_.now_ns();
  switch (device) {
    case Device::motor_left:
    case Device::motor_right:
    case Device::bus:
      if (device == Device::bus) is_miscoded_ = kind == Kind::miscoded;
      miscoding_->set(is_miscoded_);
      bus_->set(device, kind);
      return;
    case Device::imu_body:
      imu_body_.set(kind, now_ns);
      return;
    case Device::imu_foot:
      imu_foot_.set(kind, now_ns);
      return;
    case Device::tof:
      tof_.set(kind, now_ns);
      return;
    case Device::load_cell:
      load_cell_.set(kind, now_ns);
      return;
    case Device::estop:
      stop_level_ = kind == Kind::pressed || kind == Kind::wire_cut;
      stop_edge_ = kind == Kind::tapped;
      return;
    case Device::computer:
      return;  // TrialRig::set() does that
    case Device::robot:
      if (!kind || kind == Kind::tilting || kind == Kind::lifted || kind == Kind::biased)
        imu_body_.set(kind, now_ns);
      if (!kind || kind == Kind::lifted || kind == Kind::biased) imu_foot_.set(kind, now_ns);
      return;
  }
}

}  // namespace sandhopper::faults
