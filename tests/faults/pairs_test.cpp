#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <set>

#include "firmware/supervision/findings.hpp"
#include "tests/faults/setup.hpp"
#include "tools/faults/pair_table.hpp"
#include "tools/faults/trial_rig.hpp"

namespace sandhopper::faults {
namespace {

constexpr std::size_t kDrawn = 200;

// The cell of the matrix. If there is none (step of the date, full disk, restart), a new cell.
Cell cell_of(Device device, Kind kind, Phase phase) {
  for (const auto& cell : all_cells())
    if (cell.device == device && cell.kind == kind && cell.phase == phase) return cell;
  return {.device = device, .kind = kind, .phase = phase, .expected = Fault::none};
}

PairResult run(const Cell& first, const Cell& second, int delay_cycles = 20) {
  PairRunner runner(shipped_setup());
  auto result = runner.run({first, second, delay_cycles});
  EXPECT_EQ(result.problem, "") << first.name() << ", " << second.name();
  return result;
}

TEST(FaultPairs, EveryClassComesBeforeEveryOtherMoreThanAThousandInAll) {
  std::set<std::string> names, classes;
  std::set<std::pair<std::string, std::string>> ordered;
  const auto pairs = all_pairs();
  for (const auto& pair : pairs) {
    names.insert(pair.name());
    classes.insert(class_of(pair.second));
    ordered.insert({class_of(pair.first), class_of(pair.second)});
  }
  EXPECT_GE(pairs.size(), 1000U);
  EXPECT_EQ(names.size(), pairs.size());
  auto firsts = classes;
  firsts.erase("restart");
  for (const auto& first : firsts)
    for (const auto& second : classes)
      EXPECT_TRUE(ordered.contains({first, second})) << first << ", " << second;
}

TEST(FaultPairs, TheSameSeedDrawsTheSame) {
  const auto a = some_pairs(50, 7), b = some_pairs(50, 7), c = some_pairs(50, 8);
  ASSERT_EQ(a.size(), 50U);
  std::set<std::string> names;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name(), b[i].name());
    names.insert(a[i].name());
  }
  EXPECT_EQ(names.size(), 50U);
  EXPECT_NE(a[0].name(), c[0].name());
}

// Draws other pairs in each run. `hop faults --pairs` runs all of them.
TEST(FaultPairs, TwoHundredDrawnAtRandomEndInTimeNoneSilentNoneGentlerThanAlone) {
  const char* const asked = std::getenv("SANDHOPPER_PAIRS_SEED");
  const std::uint64_t seed = asked != nullptr ? std::strtoull(asked, nullptr, 10) : std::random_device()();
  PairRunner runner(shipped_setup());
  PairTable table;
  for (const auto& pair : some_pairs(kDrawn, seed)) {
    const auto result = runner.run(pair);
    EXPECT_EQ(result.problem, "") << pair.name();
    table.add(pair, result);
  }
  std::printf("%d of %zu pairs, seed %llu: %d wrong, in %d the second cannot be seen\n", table.total().pairs,
              all_pairs().size(), static_cast<unsigned long long>(seed), table.total().wrong,
              table.total().hidden);
  std::printf("again: hop faults --pairs --sample %zu --seed %llu\n", kDrawn,
              static_cast<unsigned long long>(seed));
}

// Proves that the judgement detects an unnoticed second fault.
TEST(FaultPairs, WithoutTheSecondsDetectorThePairIsWrong) {
  auto setup = shipped_setup();
  const auto first = cell_of(Device::tof, Kind::off, Phase::flight);
  // The e-stop is left out, because the transmit guard reads its line, too.
  for (const auto& second : {cell_of(Device::motor_left, Kind::error, Phase::flight),
                             cell_of(Device::bus, Kind::refused, Phase::flight),
                             cell_of(Device::bus, Kind::malformed, Phase::flight),
                             cell_of(Device::computer, Kind::watchdog, Phase::flight)}) {
    setup.without = second.expected;
    EXPECT_NE(PairRunner(setup).run({first, second, 20}).problem, "") << second.name();
  }
}

TEST(FaultPairs, OfEqualReactionsTheStricterLatchHolds) {
  const auto error = cell_of(Device::motor_left, Kind::error, Phase::flight);
  const auto stop = cell_of(Device::estop, Kind::tapped, Phase::flight);
  const auto off = cell_of(Device::bus, Kind::bus_off, Phase::flight);
  EXPECT_EQ(run(error, stop).together, Fault::emergency_stop);
  EXPECT_EQ(run(error, off).together, Fault::bus_off);
  EXPECT_EQ(run(stop, off).together, Fault::bus_off);
  EXPECT_EQ(run(stop, off, kTogether).together, Fault::bus_off);
  EXPECT_EQ(run(off, stop).together, Fault::bus_off);
}

TEST(FaultPairs, BusOffIsLeftByARestartOnlyAlsoAfterADrivesError) {
  const auto setup = shipped_setup();
  TrialRig rig(setup, setup.robot, Phase::flight, setup.folder / "latch.mcap");
  while (!rig.ready_to_break()) rig.turn();
  rig.set(Device::motor_left, Kind::error);
  for (int i = 0; i < 10; ++i) rig.turn();
  ASSERT_EQ(rig.output().fault, Fault::drive_error);
  rig.set(Device::bus, Kind::bus_off);
  for (int i = 0; i < 10; ++i) rig.turn();
  ASSERT_EQ(rig.output().fault, Fault::bus_off);
  rig.turn(Request::disarm);
  EXPECT_EQ(rig.output().state, State::fault);
  ASSERT_EQ(rig.events().size(), 1U);
  EXPECT_EQ(rig.events()[0].kind, EventKind::disarm_refused);
}

TEST(FaultPairs, ADrivesErrorIsSeenBesideTheOtherDrivesGarbage) {
  const auto garbage = cell_of(Device::motor_left, Kind::garbage, Phase::flight);
  const auto error = cell_of(Device::motor_right, Kind::error, Phase::flight);
  const auto result = run(garbage, error);
  EXPECT_EQ(result.together, Fault::drive_error);
  EXPECT_LE(result.cycles, entry_of(Fault::drive_error).cycles);
}

// A node without power acknowledges no frame. If both drives have none, no node acknowledges.
TEST(FaultPairs, BothDrivesWithoutPowerAreABusThatNobodyAcknowledges) {
  const auto left = cell_of(Device::motor_left, Kind::off, Phase::armed);
  const auto right = cell_of(Device::motor_right, Kind::off, Phase::armed);
  const auto result = run(left, right);
  EXPECT_EQ(result.together, Fault::bus_send_refused);
}

TEST(FaultPairs, ALossThatTheDriveAnnouncesIsItsError) {
  const auto stale = cell_of(Device::imu_body, Kind::off, Phase::extension);
  const auto loss = cell_of(Device::motor_right, Kind::announced_loss, Phase::extension);
  EXPECT_EQ(run(stale, loss).together, Fault::drive_error);
}

TEST(FaultPairs, ANewSessionWhileTheCauseIsThereDoesNotHop) {
  const auto restart = cell_of(Device::computer, Kind::restart, Phase::armed);
  for (const auto kind : {Kind::off, Kind::stuck, Kind::error, Kind::wrong, Kind::hot}) {
    const auto result = run(cell_of(Device::motor_left, kind, Phase::armed), restart);
    const bool refused = result.end.find("refused") != std::string::npos;
    EXPECT_TRUE(refused || result.together != Fault::none) << name_of(kind) << ": " << result.end;
  }
}

// The offset is measured while the robot hangs. Without this a fall would look like half of the weight.
TEST(FaultPairs, AnOffsetOfTheImuThatArmingMeasuredDoesNotHideTheRelease) {
  const auto biased = cell_of(Device::robot, Kind::biased, Phase::armed);
  const auto result = run(biased, cell_of(Device::computer, Kind::restart, Phase::armed));
  EXPECT_EQ(result.state, State::idle) << "hopped and stopped";
}

TEST(FaultPairs, AFullDiskAtTheEndOfTheLogIsNamed) {
  const auto error = cell_of(Device::motor_left, Kind::error, Phase::flight);
  const auto disk = cell_of(Device::computer, Kind::disk_full, Phase::flight);
  EXPECT_EQ(run(error, disk, 400).together, Fault::drive_error);
  EXPECT_EQ(run(disk, error, 1).together, Fault::drive_error);
}

}  // namespace
}  // namespace sandhopper::faults
