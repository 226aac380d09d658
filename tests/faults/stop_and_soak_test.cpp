#include <gtest/gtest.h>
#include <malloc.h>

#include <array>
#include <cstdlib>
#include <set>

#include "firmware/controller.hpp"
#include "tests/faults/setup.hpp"
#include "tools/faults/bench_board.hpp"

namespace sandhopper::faults {
namespace {

// Level, edge and cut wire while hopping: two cycles later no torque is commanded, and disarm is refused
// while the line is open.
TEST(EmergencyStop, TakesTheTorqueWithinTwoCyclesAndStaysLatched) {
  for (const auto kind : {Kind::pressed, Kind::tapped, Kind::wire_cut}) {
    const auto setup = shipped_setup();
    World world(WorldConfig{}, {}, 0);
    BenchBoard board(world, setup.robot, 1);
    Controller controller(cycle_config(setup.robot));
    SensorFrame frame;
    std::uint64_t pressed_at = 0, off_at = 0;
    State state = State::idle;
    Request request = Request::none;
    for (std::uint64_t k = 1; k < 2000; ++k) {
      frame.time_ns = static_cast<std::int64_t>(k) * 1'000'000;
      frame.cycle = k;
      frame.request = request;
      if (k == 300) frame.request = Request::arm;
      request = Request::none;
      board.read(frame);
      const auto& output = controller.step(frame);
      board.write(output.command);
      for (const auto& event : controller.events())
        if (event.kind == EventKind::armed) request = Request::release;
      state = output.state;
      if (pressed_at == 0 && state == State::extension) {
        board.set(Device::estop, kind);
        pressed_at = k + 1;
        continue;
      }
      if (pressed_at == 0) continue;
      if (off_at == 0 && output.command.drive == DriveRequest::off) off_at = k;
      if (k == pressed_at + 100) request = Request::disarm;
      if (k == pressed_at + 102) break;
    }
    ASSERT_NE(pressed_at, 0U);
    std::printf("e-stop %s: off after %d cycles\n", std::string(name_of(kind)).c_str(),
                static_cast<int>(off_at - pressed_at));
    EXPECT_LE(off_at, pressed_at + 2) << name_of(kind);
    EXPECT_NE(off_at, 0U) << name_of(kind);
    EXPECT_EQ(state, kind == Kind::tapped ? State::idle : State::fault) << name_of(kind);
  }
}

// Hops for SANDHOPPER_SOAK_S seconds of virtual time (default ten minutes). Each trial has one random fault
// or none. Every injected fault that can be seen must be raised; no sound trial may raise one.
TEST(Soak, RandomFaultsAreAllNamedAndSoundTrialsAreLeftAlone) {
  const char* const asked = std::getenv("SANDHOPPER_SOAK_S");
  const double longest_s = asked != nullptr ? std::atof(asked) : 600.0;
  auto setup = shipped_setup();
  const auto cells = all_cells();
  Random random(42, 7);
  // Allocated bytes. Resident memory is no measure, because the kernel merges pages into huge ones.
  const auto memory_kB = [] {
    const auto info = mallinfo2();
    return static_cast<long>((info.uordblks + info.hblkhd) / 1024);
  };
  double time_s = 0.0;
  int trials = 0, faults = 0, sound = 0;
  long first_kB = 0;
  while (time_s < longest_s) {
    setup.seed = static_cast<std::uint64_t>(1 + trials);
    setup.world.terrain.stiffness_N_per_m = 1000.0 + 2600.0 * random.uniform();
    const auto pick = static_cast<std::size_t>(random.uniform() * static_cast<double>(cells.size()) * 1.2);
    const bool breaks = pick < cells.size() && cells[pick].kind != Kind::limit;
    const Cell none{
        .device = Device::robot, .kind = Kind::limit, .phase = Phase::flight, .expected = Fault::none};
    const auto result = run_cell(breaks ? cells[pick] : none, setup);
    const auto name =
        breaks ? cells[pick].name() + " at " + std::string(name_of(cells[pick].phase)) : "sound";
    EXPECT_EQ(result.problem, "") << "seed " << setup.seed << ", bed "
                                  << setup.world.terrain.stiffness_N_per_m << " N/m: " << name;
    time_s += result.time_s;
    ++trials;
    (breaks ? faults : sound) += 1;
    if (trials == 20) first_kB = memory_kB();
  }
  const long growth_kB = memory_kB() - first_kB;
  std::printf("%.0f s of virtual time, %d trials, %d with a fault, %d sound; memory grew by %ld kB\n", time_s,
              trials, faults, sound, growth_kB);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(growth_kB, 2048);  // not under sanitizers: they keep freed memory and find leaks themselves
#endif
}

}  // namespace
}  // namespace sandhopper::faults
