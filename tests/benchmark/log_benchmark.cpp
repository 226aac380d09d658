#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/mcap_writer.hpp"
#include "firmware/log/spsc_ring.hpp"
#include "firmware/log/topics.hpp"
#include "firmware/log/trial_logger.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {
namespace {

constexpr int kCycles = 20'000;

std::filesystem::path scratch_file() {
  return std::filesystem::temp_directory_path() /
         ("sandhopper_benchmark_" + std::to_string(::getpid()) + ".mcap");
}

template <class Record>
void encode(benchmark::State& state) {
  Record record;
  std::array<std::byte, cdr::size_of<Record>()> bytes;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(record);
    cdr::encode(record, bytes.data());
    benchmark::DoNotOptimize(bytes);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}
BENCHMARK(encode<SensorFrame>);
BENCHMARK(encode<StepOutput>);

template <class Record>
void decode(benchmark::State& state) {
  Record record;
  std::array<std::byte, cdr::size_of<Record>()> bytes;
  cdr::encode(record, bytes.data());
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(bytes);
    benchmark::DoNotOptimize(cdr::decode(bytes, record));
    benchmark::DoNotOptimize(record);
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}
BENCHMARK(decode<SensorFrame>);
BENCHMARK(decode<StepOutput>);

void crc_of_a_chunk(benchmark::State& state) {
  const std::vector<std::byte> bytes(262'144);
  while (state.KeepRunning()) benchmark::DoNotOptimize(mcap::crc32(0, bytes));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
}
BENCHMARK(crc_of_a_chunk);

// Cost of two records per cycle, while the logger's thread takes them out of the ring.
void push_a_cycle(benchmark::State& state) {
  std::filesystem::remove(scratch_file());
  TrialLogOptions options;
  options.mcap_file = scratch_file();
  options.mcap.sync_span_ns = 0;
  TrialLogger logger(options);
  const auto frames = logger.add_topic<SensorFrame>(topic::kFrame);
  const auto outputs = logger.add_topic<StepOutput>(topic::kOutput);
  logger.start();
  SensorFrame frame;
  const StepOutput output;
  while (state.KeepRunning()) {
    frame.time_ns += 1'000'000;
    logger.push(frames, frame.time_ns, frame);
    logger.push(outputs, frame.time_ns, output);
    if (frame.time_ns % 2'000'000'000 == 0) {  // gives the logger's thread as much time as it has in a trial
      state.PauseTiming();
      ::usleep(20'000);
      state.ResumeTiming();
    }
  }
  logger.stop();
  state.counters["lost"] = static_cast<double>(logger.lost_records());
  std::filesystem::remove(scratch_file());
}
BENCHMARK(push_a_cycle)->Iterations(100'000);

void write_log() {
  std::filesystem::remove(scratch_file());
  mcap::WriterOptions options;
  options.sync_span_ns = 0;
  mcap::Writer writer(scratch_file(), options);
  const auto frames = writer.add_channel<SensorFrame>(topic::kFrame);
  const auto outputs = writer.add_channel<StepOutput>(topic::kOutput);
  SensorFrame frame;
  const StepOutput output;
  for (int i = 0; i < kCycles; ++i) {
    frame.time_ns += 1'000'000;
    writer.write(frames, {frame.time_ns, frame.time_ns}, frame);
    writer.write(outputs, {frame.time_ns, frame.time_ns}, output);
  }
  writer.close();
}

void per_cycle(benchmark::State& state) {
  const auto cycles = static_cast<double>(state.iterations()) * kCycles;
  state.counters["s_per_cycle"] =
      benchmark::Counter(cycles, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["x_real_time"] = benchmark::Counter(cycles / 1'000.0, benchmark::Counter::kIsRate);
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(std::filesystem::file_size(scratch_file())));
}

void write_a_log(benchmark::State& state) {
  while (state.KeepRunning()) write_log();
  per_cycle(state);
  std::filesystem::remove(scratch_file());
}
BENCHMARK(write_a_log)->Unit(benchmark::kMillisecond);

// Reads as a replay does: CRCs checked, frames and outputs decoded.
void read_a_log(benchmark::State& state) {
  write_log();
  SensorFrame frame;
  StepOutput output;
  while (state.KeepRunning()) {
    mcap::Reader log(scratch_file());
    TopicOf<SensorFrame> frames(topic::kFrame);
    TopicOf<StepOutput> outputs(topic::kOutput);
    for (mcap::Message message; log.next(message);) {
      benchmark::DoNotOptimize(frames.take(message, frame) || outputs.take(message, output));
      benchmark::DoNotOptimize(frame);
      benchmark::DoNotOptimize(output);
    }
  }
  per_cycle(state);
  std::filesystem::remove(scratch_file());
}
BENCHMARK(read_a_log)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sandhopper
