#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <random>

#include "tests/unit/calibration_bench.hpp"
#include "tools/calibrate/tap_intervals.hpp"
#include "tools/calibrate/timing.hpp"
#include "tools/plant/sensors.hpp"

namespace sandhopper::calibrate {
namespace {

constexpr int kTaps = 10;

// True latencies of the devices; the firmware assumes those of the default configuration.
LinuxBoardConfig real_board() {
  LinuxBoardConfig board;
  board.imu_body.latency_s = 0.00031;
  board.load_cell.latency_s = 0.00143;
  return board;
}

// All sensors have the same bandwidth, so that the planted latencies are the only differences.
WorldConfig world() {
  WorldConfig out;
  out.sensors.load_cell_bandwidth_Hz = out.sensors.imu_bandwidth_Hz;
  return out;
}

Recording tap(std::uint64_t seed, int taps = kTaps, double force_N = 60.0) {
  Step step{.prompt = "", .fixture = {.taps = taps, .tap_force_N = force_N}, .seconds = 0.5 * taps + 0.6};
  return record_on_sim(
             {}, {},
             {.world = world(), .real_robot = {}, .real_board = real_board(), .trial = {.seed = seed}},
             {step})
      .front();
}

struct Fitted {
  Outcome outcome;
  std::optional<ForeignClock> clock;
};
Fitted fit(const Recording& recording, std::optional<ForeignRecording> foreign = {}) {
  Fitted out;
  TimingSetup setup{.reference = TapSensor::imu_foot, .others = {TapSensor::imu_body, TapSensor::load_cell}};
  if (foreign) setup.others.clear();
  setup.foreign = std::move(foreign);
  out.outcome = calibrate_timing(recording, LinuxBoardConfig{}, setup, out.clock);
  return out;
}

// The foot's signal as another computer at `rate_Hz` records it: its clock is `offset_s` behind and fast by
// `drift`.
struct Other {
  double rate_Hz, offset_s, drift;
  std::uint64_t seed;
  double begin_s = 0.052;  // of our recording, after the fixture was set
};
ForeignRecording foreign_of(const Other& other) {
  const Fixture fixture{.taps = kTaps};
  std::mt19937_64 generator(other.seed);
  std::normal_distribution<double> noise(0.0, 0.2);
  LowPass filter(400.0, 1e-4);
  ForeignRecording out{"camera.csv", {}};
  double next_s = 0.0;
  for (double t = 0.0; t < 0.5 * kTaps + 0.6; t += 1e-4) {
    filter.step(fixture.tap_force_N * fixture.tap_at(t + other.begin_s));
    if (t < next_s) continue;
    next_s += 1.0 / other.rate_Hz;
    out.signal.time_s.push_back((t - other.offset_s) * (1.0 + other.drift));
    out.signal.value.push_back(filter.value() + noise(generator));
  }
  return out;
}

TEST(CalibrateTiming, FindsTheSkewOfEachSensorToAFractionOfASample) {
  Coverage latency;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto found = fit(tap(seed));
    ASSERT_EQ(reasons(found.outcome), "") << found.outcome.refusals.front().text;
    const auto& body = value_of(found.outcome, "imu_body.latency_s");
    const auto& cell = value_of(found.outcome, "load_cell.latency_s");
    latency.see(body, 0.00031);
    latency.see(cell, 0.00143);
    EXPECT_LT(body.ci95, 1e-4);
    EXPECT_LT(cell.ci95, 1e-4);
  }
  EXPECT_GE(latency.held, 19) << "of 24";
}

TEST(CalibrateTiming, FindsAnotherComputersClock) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto recording = tap(seed);
    const double begin_s = 1e-9 * static_cast<double>(recording.begin_ns);
    const auto found = fit(recording, foreign_of({1000.0, 3.2174, 5e-5, seed, begin_s}));
    ASSERT_EQ(reasons(found.outcome), "") << found.outcome.refusals.front().text;
    ASSERT_TRUE(found.clock);
    EXPECT_NEAR(found.clock->drift, -5e-5, 4e-5);
    // True offset t_recording - t_foreign at the middle of the taps.
    const double truth = 3.2174 - found.clock->middle_s * 5e-5;
    held += std::abs(found.clock->offset_s - truth) < found.clock->ci95_s;
    EXPECT_LT(found.clock->ci95_s, 1e-4);
  }
  EXPECT_GE(held, 7) << "of 10";
}

TEST(CalibrateTiming, FourTapsAreTooFew) { EXPECT_EQ(reasons(fit(tap(1, 4)).outcome), "too_few_points"); }

TEST(CalibrateTiming, ADoubleTapIsRefused) {
  auto recording = tap(1);
  // The third tap bounces: the same signal again 40 ms later.
  const std::int64_t first_ns = recording.begin_ns + 1'440'000'000;
  for (auto& sample : recording.imu_foot) {
    const double since_s = static_cast<double>(sample.time_ns - first_ns) * 1e-9 - 0.049;
    if (since_s > 0.0 && since_s < 0.008) sample.accel_mps2[2] += 25.0 * std::sin(3.14159 * since_s / 0.008);
  }
  EXPECT_EQ(reasons(fit(recording).outcome), "double_tap");
}

TEST(CalibrateTiming, ASensorAtTheEndOfItsRangeIsRefused) {
  auto recording = tap(1);
  for (auto& sample : recording.imu_body) sample.accel_mps2[2] = std::min(10.0 * sample.accel_mps2[2], 156.9);
  EXPECT_THAT(reasons(fit(recording).outcome), ::testing::HasSubstr("saturated"));
}

TEST(CalibrateTiming, ASensorThatFeelsSomethingElseIsRefused) {
  auto recording = tap(1);
  for (std::size_t i = 0; i < recording.load_cell.size(); ++i)
    recording.load_cell[i].force_N = 5.0 * std::sin(0.3 * static_cast<double>(i));
  EXPECT_THAT(reasons(fit(recording).outcome), ::testing::HasSubstr("residual_too_large"));
}

TEST(CalibrateTiming, DelaysThatScatterAreRefused) {
  auto recording = tap(1);
  for (auto& sample : recording.load_cell)
    sample.time_ns += (sample.time_ns - recording.begin_ns) / 500'000'000 % 3 * 700'000;
  EXPECT_THAT(reasons(fit(recording).outcome), ::testing::HasSubstr("interval_too_wide"));
}

TEST(CalibrateTiming, OtherTapsThanOursAreRefused) {
  auto foreign = foreign_of({.rate_Hz = 1000.0, .offset_s = 0.0, .drift = 0.0, .seed = 1});
  for (auto& t : foreign.signal.time_s) t *= 1.2;
  EXPECT_EQ(reasons(fit(tap(1), foreign).outcome), "taps_differ");
}

// Removes the taps within 0.2 s of `at_s`, in the times of the series: the recorder felt nothing.
void without_tap(Series& signal, double at_s) {
  for (std::size_t i = 0; i < signal.size(); ++i)
    if (std::abs(signal.time_s[i] - at_s) < 0.2) signal.value[i] = 0.01 * static_cast<double>(i % 3);
}

// Its taps are those of the fixture, evenly 0.5 s apart.
ForeignRecording even_foreign(const Recording& recording) {
  return foreign_of({1000.0, 3.2174, 5e-5, 1, 1e-9 * static_cast<double>(recording.begin_ns)});
}

// Time of the first tap in the foreign signal.
double first_tap_s(const ForeignRecording& foreign) {
  const double strongest = std::ranges::max(foreign.signal.value);
  for (std::size_t i = 0; i < foreign.signal.size(); ++i)
    if (foreign.signal.value[i] > 0.8 * strongest) return foreign.signal.time_s[i];
  return 0.0;
}

TEST(CalibrateTiming, EvenTapsWithOneMissingFitAtSeveralShiftsAndAreRefused) {
  const auto recording = tap(1);
  auto foreign = even_foreign(recording);
  // It recorded long enough on both sides to have felt every tap of either shift.
  for (int i = 0; i < 1000; ++i) {
    foreign.signal.time_s.push_back(foreign.signal.time_s.back() + 1e-3);
    foreign.signal.value.push_back(0.01 * (i % 3));
  }
  without_tap(foreign.signal, first_tap_s(foreign));
  const auto found = fit(recording, foreign);
  ASSERT_EQ(reasons(found.outcome), "alignment_ambiguous");
  EXPECT_THAT(
      found.outcome.refusals.front().text,
      ::testing::AllOf(::testing::HasSubstr("come evenly and fit ours at "), ::testing::HasSubstr("t + 3.2"),
                       ::testing::HasSubstr("t + 2.7"), ::testing::HasSubstr("9 taps match")));
  EXPECT_FALSE(found.clock);
}

TEST(CalibrateTiming, UnevenTapsWithOneMissingHaveOneShift) {
  auto recording = tap(1);
  auto foreign = even_foreign(recording);
  const double first_s = first_tap_s(foreign);
  // Without the taps 3 and 6 the intervals are uneven in both recordings.
  for (const int i : {3, 6}) {
    without_tap(foreign.signal, first_s + 0.5 * i);
    const double ours_s = first_s + 0.5 * i + 3.2174;
    for (auto& sample : recording.imu_foot)
      if (std::abs(1e-9 * static_cast<double>(sample.time_ns - recording.begin_ns) - ours_s) < 0.2)
        sample.accel_mps2 = recording.imu_foot.front().accel_mps2;
  }
  without_tap(foreign.signal, first_s);
  const auto found = fit(recording, foreign);
  ASSERT_EQ(reasons(found.outcome), "") << found.outcome.refusals.front().text;
  ASSERT_TRUE(found.clock);
  EXPECT_NEAR(found.clock->offset_s, 3.2174, 1e-3);
}

TEST(CalibrateTiming, TimesInAnotherUnitAreNamed) {
  const auto recording = tap(1);
  for (const auto& [unit, factor] : {std::pair{"ms", 1e3}, {"us", 1e6}, {"min", 1.0 / 60.0}}) {
    auto foreign = even_foreign(recording);
    for (auto& t : foreign.signal.time_s) t *= factor;
    const auto found = fit(recording, foreign);
    ASSERT_EQ(reasons(found.outcome), "time_unit") << unit;
    EXPECT_THAT(found.outcome.refusals.front().cure,
                ::testing::HasSubstr(std::string("--foreign-time-unit ") + unit));
  }
}

// The clock of the other computer is set by `step_s` at `at_s` of its time.
ForeignRecording with_step(const Recording& recording, double at_s, double step_s) {
  auto foreign = foreign_of({1000.0, 3.2174, 5e-5, 1, 1e-9 * static_cast<double>(recording.begin_ns)});
  for (auto& t : foreign.signal.time_s)
    if (t > at_s - 3.2174) t += step_s;
  return foreign;
}

TEST(CalibrateTiming, AFastForeignClockIsRefusedAsDriftNotAsAStep) {
  const auto recording = tap(1);
  for (const double drift : {0.01, -0.01, 0.015}) {
    auto foreign = foreign_of({1000.0, 3.2174, drift, 1, 1e-9 * static_cast<double>(recording.begin_ns)});
    const auto outcome = fit(recording, foreign).outcome;
    ASSERT_EQ(reasons(outcome), "clock_drifts") << drift;
    EXPECT_THAT(outcome.refusals.front().text,
                ::testing::HasSubstr(
                    fmt::format("runs {:.2f} % {}", 1e2 * std::abs(drift), drift > 0.0 ? "fast" : "slow")));
    for (auto& t : foreign.signal.time_s) t /= 1.0 + drift;
    EXPECT_EQ(reasons(fit(recording, foreign).outcome), "") << "the factor is the cure";
  }
}

TEST(CalibrateTiming, AForeignClockThatStepsIsRefusedWithItsStep) {
  const auto recording = tap(1);
  for (const double step_s : {0.004, 0.2, 37.0, -0.004})
    for (const double at_s : {1.35, 2.85, 4.35}) {
      const auto outcome = fit(recording, with_step(recording, at_s, step_s)).outcome;
      ASSERT_EQ(reasons(outcome), "clock_steps") << step_s << " at " << at_s;
      const auto& text = outcome.refusals.front().text;
      EXPECT_NEAR(std::stod(text.substr(text.find(" by ") + 4)), std::abs(step_s), 0.002) << text;
    }
}

// A clock that is slewed by 500 ppm, as adjtime does, from the middle of the taps on.
TEST(CalibrateTiming, AnUnevenForeignClockWidensItsInterval) {
  using ::testing::HasSubstr;
  const auto recording = tap(1);
  auto foreign = foreign_of({1000.0, 3.2174, 5e-5, 1, 1e-9 * static_cast<double>(recording.begin_ns)});
  const auto even = fit(recording, foreign);
  EXPECT_THAT(fmt::format("{}", fmt::join(even.outcome.notes, "\n")),
              ::testing::Not(HasSubstr("run evenly")));
  const double begin_s = foreign.signal.time_s.front(),
               middle_s = 0.5 * (begin_s + foreign.signal.time_s.back());
  std::vector<double> moved_s;
  for (auto& t : foreign.signal.time_s) {
    moved_s.push_back(5e-4 * std::max(0.0, t - middle_s));
    t += moved_s.back();
  }
  const auto found = fit(recording, foreign);
  EXPECT_THAT(fmt::format("{}", fmt::join(found.outcome.notes, "\n")), HasSubstr("does not run evenly"));
  ASSERT_TRUE(even.clock && found.clock);
  EXPECT_GT(found.clock->ci95_s, 3.0 * even.clock->ci95_s);
  // The error of the middle of the taps, where half of the slew lies behind.
  const double at_s = found.clock->middle_s;
  const double truth = even.clock->offset_s + even.clock->drift * (at_s - even.clock->middle_s) -
                       5e-4 * std::max(0.0, at_s - middle_s);
  EXPECT_LT(std::abs(found.clock->offset_s - truth), found.clock->ci95_s);
}

// A recorder that lost 0.2 s of rows, with the second tap, and counts its time from the rows.
TEST(CalibrateTiming, LostRowsAreNamedWithTheirTime) {
  const std::vector<double> ours{0.45, 0.95, 1.45, 1.95, 2.45, 2.95};
  const auto lost = different_taps("force.csv", ours, {2.95, 3.75, 4.25, 4.75, 5.25});
  EXPECT_EQ(lost.reason, "taps_differ");
  EXPECT_THAT(lost.text, ::testing::HasSubstr("at 2.950 and 3.750 s are 0.800 s apart"));
  EXPECT_THAT(lost.text, ::testing::HasSubstr("1.000 s apart (0.200 s missing, if these are the same taps)"));
  EXPECT_THAT(lost.cure, ::testing::HasSubstr("lost rows there and its t_s counts rows"));
  const auto others = different_taps("force.csv", ours, {0.1, 0.83, 1.44, 2.21, 3.1});
  EXPECT_THAT(others.text, ::testing::HasSubstr("(medians)"));
}

}  // namespace
}  // namespace sandhopper::calibrate
