// Fuzz target of drivers/transmit_guard: frames to be sent and received, cycles and times, in any order. The
// input begins with dialects and scales of both motors; records follow. Every frame that passes the guard
// must obey the rules.
#include "drivers/transmit_guard/transmit_guard.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "tests/fuzz/fuzz.hpp"

namespace {

using namespace sandhopper;
using namespace sandhopper::transmit;

double number(fuzz::Bytes& bytes) {
  double value = 0.0;
  const fuzz::Input raw = bytes.take(sizeof value);
  std::memcpy(&value, raw.data(), raw.size());
  return value;
}

// Valid scales or, if the input asks for it, arbitrary numbers.
MotorLimits take_motor(fuzz::Bytes& bytes, std::uint32_t id) {
  MotorLimits motor;
  const std::uint8_t choice = bytes.byte();
  motor.dialect = static_cast<Dialect>(choice % 3);
  motor.can_id = id;
  motor.master_id = bytes.byte();
  motor.sign = (choice & 0x10) != 0 ? -1 : 1;
  motor.gear_ratio = 0.25 * (1 + (choice >> 5));
  if (motor.dialect == Dialect::servo) motor.status_rate_Hz = 500.0;
  if ((choice & 0x08) == 0) return motor;
  for (double* any :
       {&motor.torque_range_Nm, &motor.kp_range_Nm_per_rad, &motor.torque_Nm, &motor.kp_Nm_per_rad,
        &motor.kd_Nm_s_per_rad, &motor.speed_radps, &motor.torque_constant_Nm_per_A})
    *any = number(bytes);
  return motor;
}

can_frame take_frame(fuzz::Bytes& bytes, std::uint32_t id) {
  can_frame frame{};
  frame.can_id = id;
  const std::uint8_t length = bytes.byte();
  if ((length & 0x80) != 0) frame.can_id ^= static_cast<std::uint32_t>(bytes.byte()) << (length & 0x1F);
  frame.can_dlc = (length & 0x40) != 0 ? bytes.byte() : length % 9;
  const fuzz::Input data = bytes.take(CAN_MAX_DLEN);
  std::memcpy(frame.data, data.data(), data.size());
  return frame;
}

class Line {
 public:
  explicit Line(const Limits& limits) : limits_(limits), guard_(limits) {}

  void record(fuzz::Bytes& bytes) {
    const std::uint8_t head = bytes.byte();
    const std::size_t motor = head >> 4 & 1;
    const std::uint32_t id = limits_.motor[motor].can_id;
    const bool extended = limits_.motor[motor].dialect != Dialect::mit;
    switch (head & 7) {
      case 0:
        begin(bytes);
        return;
      case 1:
        guard_.received(take_frame(bytes, extended ? id | 0x2900U | CAN_EFF_FLAG : head & 0x80U ? id : 0U));
        return;
      case 2:
        now_ns_ += 10'000 * bytes.byte();
        guard_.advance(10'000 * bytes.byte());
        return;
      case 3:
        guard_.refused();
        refused_ = true;
        return;
      default:
        send(take_frame(bytes, FrameDecoder(limits_.motor[motor]).command_id()), (head & 0x08) != 0);
    }
  }

 private:
  void begin(fuzz::Bytes& bytes) {
    const std::uint8_t state = bytes.byte();
    now_ns_ += 50'000 * bytes.byte();
    allowance_ = static_cast<Allowance>(state & 3);
    stopped_ = (state & 0x0C) == 0x0C;
    guard_.begin({.now_ns = now_ns_, .allowance = allowance_, .emergency_stop = stopped_});
    guard_.begin_frames();
  }

  void send(const can_frame& frame, bool taken) {
    const auto verdict = guard_.judge(frame);
    if (verdict.rule != Rule::none) return;
    const auto& d = verdict.decoded;
    const auto& limit = limits_.motor[verdict.motor];
    const FrameDecoder decoder(limit);
    const auto& count = decoder.count();
    fuzz::require(verdict.known && verdict.motor < kMotorCount, "what passes is a motor's");
    fuzz::require(d.meaning != Meaning::no_frame && d.meaning != Meaning::set_zero,
                  "what passes is a command");
    const bool away = d.meaning == Meaning::zero || d.meaning == Meaning::leave;
    fuzz::require(away || (!stopped_ && !refused_), "only torque-free frames after e-stop and refusal");
    fuzz::require(away || allowance_ != Allowance::no_torque, "only torque-free frames while limp");
    fuzz::require(away || d.meaning == Meaning::enter || guard_.confirmed(verdict.motor),
                  "torque in motor mode only");
    fuzz::require(allowance_ != Allowance::damping || d.meaning != Meaning::law, "damping only");
    const auto within = [](double value, double most, double tolerance) {
      return std::abs(value) <= most * (1.0 + 1e-6) + tolerance;
    };
    fuzz::require(away || d.meaning == Meaning::enter ||
                      (within(d.torque_Nm, limit.torque_Nm, count.torque_Nm) &&
                       within(d.kp_Nm_per_rad, limit.kp_Nm_per_rad, count.kp_Nm_per_rad) &&
                       within(d.kd_Nm_s_per_rad, limit.kd_Nm_s_per_rad, count.kd_Nm_s_per_rad)),
                  "torque and gains within their limits");
    if (taken) guard_.sent(verdict, now_ns_);
  }

  Limits limits_;
  TransmitGuard guard_;
  std::int64_t now_ns_ = 0;
  Allowance allowance_ = Allowance::motion;
  bool stopped_ = true, refused_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes bytes({data, size});
  Limits limits;
  for (std::uint32_t i = 0; i < kMotorCount; ++i) limits.motor[i] = take_motor(bytes, i + 1);
  Line line(limits);
  while (!bytes.empty()) line.record(bytes);
  return 0;
}
