#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "firmware/freeze/freeze_recorder.hpp"

namespace sandhopper {

// Folders of one test for frames and memory, removed by the destructor.
class Folders {
 public:
  Folders() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    root_ = std::filesystem::temp_directory_path() /
            ("freeze_tests." + std::to_string(::getpid()) + "." + test->name());
    std::filesystem::remove_all(root_);
    std::filesystem::create_directories(memory());
    ::setenv("SANDHOPPER_FREEZE_MEMORY", memory().c_str(), 1);
  }
  ~Folders() { std::filesystem::remove_all(root_); }
  Folders(const Folders&) = delete;
  Folders& operator=(const Folders&) = delete;

  std::filesystem::path frames() const { return root_ / "frames"; }
  std::filesystem::path memory() const { return root_ / "memory"; }
  const std::filesystem::path& root() const { return root_; }

  FreezeOptions options() {
    return {.folder = frames(),
            .newest = 20,
            .log_file = root_ / "trial_007.mcap",
            .start_ns = 1'000'000,
            .realtime_offset_ns = 1'700'000'000'000'000'000,
            .description = {},
            .warn = [this](const std::string& text) { warnings.push_back(text); },
            .told = [this](const std::filesystem::path& frame) { told.push_back(frame); }};
  }

  std::vector<std::string> warnings;
  std::vector<std::filesystem::path> told;

 private:
  std::filesystem::path root_;
};

// Pushes cycles of 1 ms; raises a fault at the cycle that `fault` states.
class MadeUpCycles {
 public:
  void run(FreezeRing& ring, std::uint64_t cycles) {
    for (std::uint64_t i = 0; i < cycles; ++i) push(ring, Fault::none);
  }
  void raise(FreezeRing& ring, Fault fault) { push(ring, fault); }
  std::uint64_t cycle() const { return cycle_; }

 private:
  void push(FreezeRing& ring, Fault fault) {
    ++cycle_;
    SensorFrame frame;
    frame.cycle = cycle_;
    frame.time_ns = static_cast<std::int64_t>(cycle_) * 1'000'000 + 1'000'000;
    frame.load_cell.force_N = static_cast<double>(cycle_);
    StepOutput output;
    output.cycle = cycle_;
    output.time_ns = frame.time_ns;
    if (fault == Fault::none) {
      ring.push(frame, output, {});
      return;
    }
    const Event event{.time_ns = frame.time_ns,
                      .kind = EventKind::fault_raised,
                      .reason = Reason::fault,
                      .fault = fault,
                      .values = {0.0, 4.0, 0.0, 0.0}};
    ring.push(frame, output, {&event, 1});
  }

  std::uint64_t cycle_ = 0;
};

}  // namespace sandhopper
