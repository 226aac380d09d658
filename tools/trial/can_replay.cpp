#include "tools/trial/can_replay.hpp"

#include <algorithm>
#include <bit>
#include <memory>

#include "drivers/can/can_socket.hpp"
#include "drivers/can/cubemars_drives.hpp"
#include "drivers/device_error.hpp"
#include "firmware/log/candump.hpp"

namespace sandhopper {
namespace {

constexpr std::int64_t kPatience_ns = 200'000'000;

can_frame as_can_frame(const CandumpFrame& frame) {
  can_frame out{};
  out.can_id = frame.id;
  out.can_dlc = frame.length;
  std::copy_n(frame.data.begin(), frame.length, out.data);
  return out;
}

FrameDirection direction_of(const CandumpFrame& frame) {
  switch (frame.direction) {
    case CanDirection::sent:
      return FrameDirection::sent;
    case CanDirection::received:
      return FrameDirection::received;
    default:
      return FrameDirection::unknown;
  }
}

// The robot's driver on the interface, and beside it a plain socket that puts the trace's frames there.
class Stage {
 public:
  explicit Stage(const CanConfig& config) : player_(config.interface, {}), drives_(config) {}

  // Sends a frame that the decoder took for a reply and waits until the driver has read it.
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
  const auto both = std::min(result.decoded.size(), result.driven->size());
  for (std::size_t i = 0; i < both; ++i)
    different += !same_values(result.decoded[i].reading, (*result.driven)[i]);
  return different;
}

}  // namespace

CanReplayResult replay_can(const std::filesystem::path& trace, const CanConfig& config,
                           const std::optional<std::string>& interface,
                           const std::function<void(std::uint64_t frames)>& progress) {
  CandumpReader reader(trace);
  CanTraceDecoder decoder(config);
  CanReplayResult result;
  std::unique_ptr<Stage> stage;
  if (interface) {
    CanConfig on_interface = config;
    on_interface.interface = *interface;
    stage = std::make_unique<Stage>(on_interface);
    result.driven.emplace();
  }
  CandumpFrame line;
  std::string_view name;
  while (reader.next(line, name)) {
    ++result.frames;
    const can_frame frame = as_can_frame(line);
    if (const auto reading = decoder.decode(frame, line.time_ns, direction_of(line))) {
      result.decoded.push_back({line.time_ns, *reading});
      if (stage) stage->play(frame, *result.driven);
    }
    if (progress && result.frames % 1024 == 0) progress(result.frames);
  }
  for (std::size_t i = 0; i < decoder.bus().motor_count(); ++i)
    result.rejected += decoder.bus().counters(static_cast<Side>(i)).rejected;
  if (stage) {
    result.overflows = stage->overflows();
    result.different = count_different(result);
  }
  return result;
}

}  // namespace sandhopper
