#pragma once
#include <linux/can.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/can/can_config.hpp"
#include "drivers/can/drive_sequence.hpp"
#include "drivers/can/position_unwrap.hpp"
#include "drivers/can/servo_protocol.hpp"
#include "drivers/motor_command.hpp"
#include "drivers/samples.hpp"

namespace sandhopper {

// Value of MotorSample::error_code besides the drive's own 0 to 7: the position field is near the end of its
// range, where it saturates or wraps.
inline constexpr std::uint8_t kErrorPositionNearRangeEnd = 100;

// One motor's conversion between link side (MotorSample, MotorCommand) and drive side (MIT fields):
//   position_link = zero_offset + sign p / gear,  torque_drive = sign torque_link / gear . K_drive / K,
// and gains likewise by 1 / gear^2; current = sign torque_drive / K_drive, with K_drive the torque constant
// that the drive uses. Status frames of servo and v3 carry the current itself. Throws std::invalid_argument
// for an invalid configuration.
class CubeMarsCodec {
 public:
  explicit CubeMarsCodec(const CubeMarsConfig& config);

  // A command with a value that is not finite becomes one without gains and torque.
  MitCommand to_drive(const MotorCommand& command) const noexcept;
  MotorCommand to_link(const MitCommand& command) const noexcept;
  MotorSample to_sample(const MitReply& reply, std::int64_t time_ns) const noexcept;
  MitReply to_reply(const MotorSample& sample) const noexcept;

  MotorSample to_sample(const ServoStatus& status, std::int64_t time_ns) const noexcept;

  // MIT dialect only.
  can_frame command_frame(const MotorCommand& command) const noexcept;
  can_frame special_frame(const MitPayload& payload) const noexcept;

  // Frame of an action in this drive's dialect; empty for DriveAction::none. Servo mode has no gains: the
  // torque is computed here from `newest`. Without a newest sample only the feed-forward torque is sent.
  std::optional<can_frame> frame(DriveAction action, const MotorCommand& command,
                                 const MotorSample& newest) const noexcept;

  // Appends filters for the frames that this drive may send and for the echoes of its commands.
  void add_filters(std::vector<can_filter>& filters) const;

  // foreign: a frame of this drive in another dialect. malformed: in its own dialect, but with a wrong
  // length.
  enum class Match : std::uint8_t { other, reply, malformed, foreign };
  Match match(const can_frame& frame) const noexcept;

  // True if `id`, with its flags, is that of a command to this drive in its dialect. Servo accepts modes 0 to
  // 6. In the MIT dialect a drive may also answer on this identifier.
  bool is_command_id(canid_t id) const noexcept;

  // Decodes a frame for which match() gave Match::reply.
  MotorSample sample_of(const can_frame& frame, std::int64_t time_ns) const noexcept;

  // True if the drive answers each command with one frame. Otherwise it sends its status by itself.
  bool answers_commands() const noexcept { return config_.dialect != Dialect::servo; }

  const CubeMarsConfig& config() const noexcept { return config_; }
  const MitRanges& ranges() const noexcept { return ranges_; }

 private:
  CubeMarsConfig config_;
  std::optional<can_frame> current_frame(ServoMode mode, double current_A) const noexcept;

  MitRanges ranges_;
  double torque_to_drive_;
};

struct CubeMarsCounters {
  std::uint32_t replies = 0;
  std::uint32_t missed = 0;       // commands without an answer before the next command
  std::uint32_t unsolicited = 0;  // replies without a command outstanding: two drives with one id, or a
                                  // recorded trace
  std::uint32_t rejected = 0;     // frames that do not match the dialect
  std::uint32_t foreign = 0;      // rejected frames of another dialect: the drive is in another mode

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("replies", self.replies);
    visit("missed", self.missed);
    visit("unsolicited", self.unsolicited);
    visit("rejected", self.rejected);
    visit("foreign", self.foreign);
  }
};

struct MotorReading {
  Side side = Side::left;
  MotorSample sample{};
};

// Decoder for the drives of one bus, without I/O. It finds the motor that a frame belongs to and the command
// that it answers. A drive samples its state when the command arrives, so a reply gets the command's time.
class CubeMarsBus {
 public:
  // Throws std::invalid_argument when two drives cannot be told apart or a dialect is not implemented.
  explicit CubeMarsBus(const CanConfig& config);

  // The identifiers that may carry a reply, and those of drives in another mode.
  std::vector<can_filter> filters() const;

  std::size_t motor_count() const noexcept { return codecs_.size(); }
  const CubeMarsCodec& codec(Side side) const noexcept { return codecs_[index(side)]; }

  // A command for this motor went out at `time_ns`; one still unanswered counts as missed.
  void command_sent(Side side, std::int64_t time_ns) noexcept;

  // A frame that arrived at `time_ns`. Empty if it is no reply of these drives.
  std::optional<MotorReading> receive(const can_frame& frame, std::int64_t time_ns) noexcept;

  // True while the last command may still be answered. No other command should follow until then.
  bool outstanding(Side side, std::int64_t now_ns) const noexcept;

  const CubeMarsCounters& counters(Side side) const noexcept { return counters_[index(side)]; }

  // Frames that belong to no motor.
  std::uint32_t strangers() const noexcept { return strangers_; }

 private:
  static constexpr std::size_t index(Side side) { return static_cast<std::size_t>(side); }
  std::int64_t state_time(std::size_t i, std::int64_t time_ns) noexcept;

  struct Outstanding {
    bool waiting = false;
    bool previous_missed = false;
    std::int64_t sent_ns = 0;
    std::int64_t previous_ns = 0;
  };

  std::vector<CubeMarsCodec> codecs_;
  std::array<CubeMarsCounters, kMotorCount> counters_{};
  std::array<Outstanding, kMotorCount> outstanding_{};
  std::array<PositionUnwrap, kMotorCount> unwrap_{};
  std::uint32_t strangers_ = 0;
};

// Decoder of a recorded trace: commands and replies of both motors in the order of the bus.
enum class FrameDirection : std::uint8_t { unknown, sent, received };

class CanTraceDecoder {
 public:
  explicit CanTraceDecoder(const CanConfig& config) : bus_(config) {}

  // A reply gives a reading; a command sets the time of the next reply. If the direction is unknown, a frame
  // on a motor's command identifier is a reply only if byte 0 is that identifier, as in every reply.
  std::optional<MotorReading> decode(const can_frame& frame, std::int64_t time_ns,
                                     FrameDirection direction = FrameDirection::unknown) noexcept;

  const CubeMarsBus& bus() const noexcept { return bus_; }

 private:
  CubeMarsBus bus_;
};

}  // namespace sandhopper
