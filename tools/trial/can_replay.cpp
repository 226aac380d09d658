#include "tools/trial/can_replay.hpp"

#include <algorithm>
#include <bit>
#include <memory>

#include "drivers/can/can_socket.hpp"
#include "drivers/can/cubemars_drives.hpp"
#include "drivers/device_error.hpp"
#include "firmware/log/candump.hpp"
#include "tools/trial/trace/trace_file.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kPatience_ns = 200'000'000;

// The robot's driver on the interface, and a plain socket that sends the trace's frames to it.
class Stage {
 public:
  explicit Stage(const CanConfig& config) : player_(config.interface, {}), drives_(config) {}

  // Sends a frame that the decoder recognised as a reply, and waits until the driver has read it.
  void play(const can_frame& frame, std::vector<MotorReading>& readings) {
    while (!player_.send(frame)) drives_.wait(1'000'000);
    const auto before = readings.size();
    while (readings.size() == before && drives_.wait(kPatience_ns))
      drives_.drain([&](const MotorReading& reading) { readings.push_back(reading); });
  }
  std::uint32_t overflows() const { return drives_.port_counters().receive_overflows; }

 private:
  CanSocket player_;
  CubeMarsDrives drives_;
};

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_values(const MotorReading& a, const MotorReading& b) {
  return a.side == b.side && same_bits(a.sample.position_rad, b.sample.position_rad) &&
         same_bits(a.sample.velocity_radps, b.sample.velocity_radps) &&
         same_bits(a.sample.current_A, b.sample.current_A) && a.sample.error_code == b.sample.error_code;
}

std::uint64_t count_different(const CanReplayResult& result) {
  std::uint64_t different = 0;
  const auto both = std::min(result.trace.decoded.size(), result.driven->size());
  for (std::size_t i = 0; i < both; ++i)
    different += !same_values(result.trace.decoded[i].reading, (*result.driven)[i]);
  return different;
}

}  // namespace

CanReplayResult replay_can(const std::filesystem::path& file, const CanReplaySetup& setup,
                           const std::function<void(std::uint64_t frames)>& progress) {
  std::unique_ptr<Stage> stage;
  if (setup.interface) {
    CanConfig on_interface = setup.config;
    on_interface.interface = *setup.interface;
    stage = std::make_unique<Stage>(on_interface);
  }
  auto recorded = trace::read_trace(file, setup.bus, progress);
  if (recorded.frames.empty() && recorded.unreadable.count > 0) throw CandumpError(recorded.unreadable.first);
  CanReplayResult result;
  result.trace = trace::examine_trace(std::move(recorded), setup.config, setup.limits);
  if (!stage) return result;
  result.driven.emplace();
  for (const auto& reading : result.trace.decoded) stage->play(reading.frame, *result.driven);
  result.overflows = stage->overflows();
  result.different = count_different(result);
  return result;
}

}  // namespace sandhopper
