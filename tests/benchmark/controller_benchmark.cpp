// Controller::step on a recorded stride. Every call is timed, so that the tail is visible and not only the
// mean. The cost of reading the clock is included in each figure and printed beside it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "firmware/controller.hpp"
#include "tools/plant/sim_board.hpp"

namespace sandhopper {
namespace {

std::vector<SensorFrame> record_trial() {
  std::vector<SensorFrame> frames;
  World world(WorldConfig{}, {}, 0);
  SimBoard board(world);
  Controller controller(CycleConfig{});
  SensorFrame frame;
  Request request = Request::arm;
  for (std::int64_t k = 1; k < 900; ++k) {
    frame.time_ns = k * 1'000'000;
    frame.cycle = static_cast<std::uint64_t>(k);
    frame.request = request;
    request = Request::none;
    board.read(frame);
    frames.push_back(frame);
    board.write(controller.step(frame).command);
    for (const auto& event : controller.events())
      if (event.kind == EventKind::armed) request = Request::release;
    if (controller.stride_finished()) break;
  }
  return frames;
}

double quantile(std::vector<double>& values, double share) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

using Clock = std::chrono::steady_clock;
double ns_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double, std::nano>(b - a).count();
}

void step_each(benchmark::State& state) {
  const auto frames = record_trial();
  std::vector<double> step_ns, clock_ns;
  for (auto _ : state) {
    Controller controller(CycleConfig{});
    for (const auto& frame : frames) {
      const auto before = Clock::now();
      auto command = controller.step(frame).command;
      benchmark::DoNotOptimize(command);
      const auto after = Clock::now();
      step_ns.push_back(ns_between(before, after));
      clock_ns.push_back(ns_between(after, Clock::now()));
    }
  }
  state.counters["step_p50_ns"] = quantile(step_ns, 0.5);
  state.counters["step_p99_ns"] = quantile(step_ns, 0.99);
  state.counters["step_p99_9_ns"] = quantile(step_ns, 0.999);
  state.counters["step_max_ns"] = quantile(step_ns, 1.0);
  state.counters["clock_p50_ns"] = quantile(clock_ns, 0.5);
  state.counters["steps"] = static_cast<double>(step_ns.size());
}
BENCHMARK(step_each)->Unit(benchmark::kMillisecond)->MinTime(2.0);

// Mean without reading the clock. Run this one under `perf stat` or callgrind to count instructions.
void step_stride(benchmark::State& state) {
  const auto frames = record_trial();
  for (auto _ : state) {
    Controller controller(CycleConfig{});
    for (const auto& frame : frames) {
      auto command = controller.step(frame).command;
      benchmark::DoNotOptimize(command);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(frames.size()));
}
BENCHMARK(step_stride)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sandhopper
