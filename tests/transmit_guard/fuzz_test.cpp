#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>

#include "config/files.hpp"
#include "tests/transmit_guard/guard_bench.hpp"
#include "tests/transmit_guard/random_robot.hpp"

// Hostile cycles: the real controller and driver behind the guard, on emulated drives. Configurations, sensor
// values, requests, timing, bus and devices are random. No frame that breaks a rule may leave, and a sound
// driver must not be refused.
namespace sandhopper::faults {
namespace {

constexpr std::uint64_t kLongest_cycles = 3000;

struct Totals {
  std::uint64_t cycles = 0, trials = 0, refusals = 0, breaches = 0;
  std::uint64_t frames = 0, torque_frames = 0, gain_frames = 0;
  std::uint64_t armed = 0, hops = 0;
  double most_torque_share = 0.0;
  std::map<Fault, int> faults;
  std::map<State, std::uint64_t> states;
};

// Overwrites measured values for some cycles with impossible ones.
class Sabotage {
 public:
  explicit Sabotage(std::uint64_t seed) : random_(seed, 11), rate_(random_.uniform() < 0.6 ? 0.0 : 0.002) {}

  void operator()(SensorFrame& frame) {
    if (left_ == 0 && random_.uniform() < rate_) {
      left_ = whole(random_, 1, 20);
      place_ = whole(random_, 0, kPlaces - 1);
      value_ = hostile();
    }
    if (left_ == 0) return;
    --left_;
    double& place = value_at(frame, place_);
    place = relative_ ? place * value_ : value_;
  }

 private:
  static constexpr int kPlaces = 14;
  static double& value_at(SensorFrame& f, int place) {
    auto& motor = f.motor[static_cast<std::size_t>(place) % kMotorCount];
    switch (place / 2) {
      case 0:
        return motor.position_rad;
      case 1:
        return motor.velocity_radps;
      case 2:
        return motor.current_A;
      case 3:
        return place % 2 == 0 ? f.tof.height_m : f.load_cell.force_N;
      case 4:
        return (place % 2 == 0 ? f.imu_body : f.imu_foot).accel_mps2[2];
      case 5:
        return (place % 2 == 0 ? f.imu_body : f.imu_foot).gyro_radps[0];
      default:
        return motor.temperature_C;
    }
  }
  double hostile() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr std::array values{std::numeric_limits<double>::quiet_NaN(),
                                kInfinity,
                                -kInfinity,
                                std::numeric_limits<double>::max(),
                                std::numeric_limits<double>::lowest(),
                                std::numeric_limits<double>::denorm_min(),
                                0.0,
                                1e9,
                                -1e9,
                                12.5};
    relative_ = random_.uniform() < 0.4;
    if (relative_) return 1.0 + 0.2 * random_.normal();
    if (random_.uniform() < 0.4) return 10.0 * random_.normal();
    return values[static_cast<std::size_t>(whole(random_, 0, static_cast<int>(values.size()) - 1))];
  }

  Random random_;
  double rate_;
  int left_ = 0, place_ = 0;
  double value_ = 0.0;
  bool relative_ = false;
};

// Breaks a device at random and may repair it later.
class Breakage {
 public:
  explicit Breakage(std::uint64_t seed) : random_(seed, 12), rate_(random_.uniform() < 0.5 ? 0.0 : 0.0015) {}

  void operator()(BenchBoard& board) {
    if (device_ && random_.uniform() < 0.02) {
      board.set(*device_, std::nullopt);
      device_.reset();
      return;
    }
    if (device_ || random_.uniform() >= rate_) return;
    const auto device = static_cast<Device>(whole(random_, 0, kDevices - 1));
    const auto kind = static_cast<Kind>(whole(random_, 0, kKinds - 1));
    if (kind == Kind::miscoded) return;  // a defect of the driver, not of a device
    device_ = device;
    board.set(device, kind);
  }

 private:
  static constexpr int kDevices = static_cast<int>(EnumNames<Device>::value.size());
  static constexpr int kKinds = static_cast<int>(EnumNames<Kind>::value.size());
  Random random_;
  double rate_;
  std::optional<Device> device_;
};

// An operator who mostly arms and releases, and sometimes requests anything.
class Operator {
 public:
  explicit Operator(std::uint64_t seed) : random_(seed, 13), rate_(random_.uniform() < 0.5 ? 0.0 : 0.005) {}

  Request operator()(const StepOutput& output, std::uint64_t cycle) {
    if (random_.uniform() < rate_) return static_cast<Request>(whole(random_, 0, 4));
    if (output.state == State::idle && cycle > 30 && random_.uniform() < 0.05) return Request::arm;
    if (output.state == State::armed && random_.uniform() < 0.03) return Request::release;
    if (output.state == State::fault && random_.uniform() < 0.02) return Request::disarm;
    return Request::none;
  }

 private:
  Random random_;
  double rate_;
};

void run_trial(const RobotConfig& shipped, std::uint64_t seed, Totals& totals) {
  Random random(seed, 10);
  const auto robot = random_robot(shipped, random);
  const double skip_rate = random.uniform() < 0.5 ? 0.0 : 0.005;
  Breakage breakage(seed);
  Operator person(seed);
  GuardBench bench(robot, seed, {.sensors = Sabotage(seed)});
  Request request = Request::none;
  State before = State::idle;
  std::uint64_t skipped_at = 0;
  while (bench.cycles() < kLongest_cycles) {
    // Gaps are at least 50 cycles apart. Several in a row would end arming, which depends on time, before the
    // drives are on.
    const bool skips = random.uniform() < skip_rate && bench.cycles() > skipped_at + 50;
    if (skips) skipped_at = bench.cycles();
    const auto& output = bench.turn(request, skips ? static_cast<std::uint64_t>(whole(random, 1, 30)) : 0);
    request = person(output, bench.cycles());
    breakage(bench.board());
    ++totals.cycles;
    ++totals.states[output.state];
    totals.armed += output.state == State::armed && before != State::armed;
    totals.hops += output.state == State::flight && before == State::armed;
    before = output.state;
    for (const auto& event : bench.controller().events())
      if (event.kind == EventKind::fault_raised) ++totals.faults[event.fault];
  }
  const auto& wire = bench.wire();
  totals.frames += wire.frames;
  totals.torque_frames += wire.torque_frames;
  totals.gain_frames += wire.gain_frames;
  totals.most_torque_share = std::max(totals.most_torque_share, wire.most_torque_share);
  ++totals.trials;
  totals.breaches += !wire.breach.empty();
  totals.refusals += bench.refused().count > 0;
  EXPECT_EQ(wire.breach, "") << "seed " << seed;
  EXPECT_EQ(bench.refused().count, 0U)
      << "seed " << seed << ", " << name_of(robot.motor[0].dialect) << ": " << name_of(bench.refused().rule);
}

std::uint64_t number_of(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

// The long run sets SANDHOPPER_GUARD_CYCLES=10000000. SANDHOPPER_GUARD_SEED selects other random trials.
TEST(GuardFuzz, NothingBeyondTheRulesLeavesAndASoundDriverIsNotRefused) {
  const auto cycles = number_of("SANDHOPPER_GUARD_CYCLES", 60'000);
  const auto first = number_of("SANDHOPPER_GUARD_SEED", 1);
  const auto shipped = load_robot(std::filesystem::path(SANDHOPPER_SOURCE_DIR) / "config");
  Totals totals;
  while (totals.cycles < cycles && !::testing::Test::HasFailure())
    run_trial(shipped, first + totals.trials, totals);
  fmt::print("seeds {} to {}: {} cycles in {} trials, armed {} times, {} releases\n", first,
             first + totals.trials - 1, totals.cycles, totals.trials, totals.armed, totals.hops);
  fmt::print(
      "frames on the wire {}, with torque {}, with gains only {}; largest torque {:.4f} of its limit\n",
      totals.frames, totals.torque_frames, totals.gain_frames, totals.most_torque_share);
  fmt::print("trials with a broken rule on the wire {}, with a refusal {}; faults:", totals.breaches,
             totals.refusals);
  for (const auto& [fault, count] : totals.faults) fmt::print(" {} {}", name_of(fault), count);
  fmt::print("\n");
  EXPECT_GT(totals.torque_frames, totals.cycles / 20) << "too few cycles with torque to show anything";
  EXPECT_GT(totals.gain_frames, 0U);
}

}  // namespace
}  // namespace sandhopper::faults
