// Fuzz target of drivers/can: CAN frames to motor readings. Each record of the input: direction, time step,
// identifier, length, data.
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "drivers/can/cubemars.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;

bool is_finite_or_unset(double value) { return !std::isinf(value); }

void require_sane(const MotorReading& reading) {
  fuzz::require(static_cast<std::size_t>(reading.side) < kMotorCount, "a reading of a motor there is");
  fuzz::require(std::isfinite(reading.sample.position_rad) && std::isfinite(reading.sample.velocity_radps),
                "position and velocity are numbers");
  fuzz::require(is_finite_or_unset(reading.sample.current_A), "the current is a number or not measured");
}

// Packing the fields of a reply again must give the same bytes.
void require_round_trip(fuzz::Input payload) {
  const MitRanges ranges;
  for (std::size_t f = 0; f < EnumNames<ReplyFlavour>::value.size(); ++f) {
    const auto flavour = static_cast<ReplyFlavour>(f);
    const auto reply = unpack_mit_reply(ranges, flavour, payload);
    if (!reply) continue;
    const auto again = pack_mit_reply(ranges, flavour, *reply);
    for (std::size_t i = 0; i < 6 && i < payload.size(); ++i)
      fuzz::require(again[i] == payload[i], "a reply packed again has the same first six bytes");
  }
}

// Commands are truncated to whole counts, as the drives' own code does. Packed again, a field is the same or
// one count less.
void require_within_a_count(const MitPayload& payload) {
  const MitRanges r;
  const MitCommand once = unpack_mit_command(r, payload);
  const MitCommand twice = unpack_mit_command(r, pack_mit_command(r, once));
  const auto near = [](double a, double b, double range, int counts) {
    return std::abs(a - b) <= 1.01 * range / counts;
  };
  fuzz::require(near(once.position_rad, twice.position_rad, 2.0 * r.position_rad, 65'535) &&
                    near(once.velocity_radps, twice.velocity_radps, 2.0 * r.velocity_radps, 4'095) &&
                    near(once.kp_Nm_per_rad, twice.kp_Nm_per_rad, r.kp_Nm_per_rad, 4'095) &&
                    near(once.kd_Nm_s_per_rad, twice.kd_Nm_s_per_rad, r.kd_Nm_s_per_rad, 4'095) &&
                    near(once.torque_Nm, twice.torque_Nm, 2.0 * r.torque_Nm, 4'095),
                "a command packed again is the same within a count");
}

can_frame take_frame(fuzz::Bytes& bytes) {
  can_frame frame{};
  const fuzz::Input id = bytes.take(4);
  std::memcpy(&frame.can_id, id.data(), id.size());
  frame.can_dlc = bytes.byte();  // a broken driver may give any length
  const fuzz::Input data = bytes.take(CAN_MAX_DLEN);
  std::memcpy(frame.data, data.data(), data.size());
  return frame;
}

template <class Decoder>
Decoder make(ReplyFlavour flavour, int sign) {
  CanConfig config;
  for (auto& motor : config.motor) motor.reply = flavour, motor.sign = sign;
  return Decoder(config);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes({data, size});
  const std::uint8_t choice = bytes.byte();
  const auto flavour = static_cast<ReplyFlavour>(choice % EnumNames<ReplyFlavour>::value.size());
  const int sign = (choice & 0x80) != 0 ? -1 : 1;
  auto trace = make<CanTraceDecoder>(flavour, sign);
  auto bus = make<CubeMarsBus>(flavour, sign);
  std::int64_t time_ns = 0;
  while (!bytes.empty()) {
    const std::uint8_t head = bytes.byte();
    time_ns += 10'000 * (head >> 2);
    const can_frame frame = take_frame(bytes);
    if (const auto reading = trace.decode(frame, time_ns, static_cast<FrameDirection>((head & 3) % 3)))
      require_sane(*reading);
    if ((head & 1) != 0) bus.command_sent((head & 2) != 0 ? Side::left : Side::right, time_ns);
    if (const auto reading = bus.receive(frame, time_ns)) require_sane(*reading);
    require_round_trip({frame.data, std::min<std::size_t>(frame.can_dlc, CAN_MAX_DLEN)});
    MitPayload payload{};
    std::memcpy(payload.data(), frame.data, payload.size());
    require_within_a_count(payload);
  }
  return 0;
}
