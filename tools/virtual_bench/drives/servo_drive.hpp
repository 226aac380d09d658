#pragma once
#include "tools/virtual_bench/drives/emulated_drive.hpp"

namespace sandhopper::bench {

// A drive of board V1/V2 in servo mode, or of board V3, whose one firmware knows the servo modes and MIT as
// mode 8 (manuals V1.0.18 section 4.4 and V3.0.0 section 4):
//   - extended identifiers, mode << 8 | id; it obeys duty (as off), current, current brake and, on V3, mode 8
//   - sends its status, identifier 0x2900 | id, `status_rate_Hz` times a second; V3 in query mode answers
//     every command with it instead
//   - no frames to enter or leave: the last command holds, for a second without frames, then no torque
// V3's mode 8 has another order of fields than MIT mode of V1/V2: gains first.
class ServoDrive : public EmulatedDrive {
 public:
  ServoDrive(const CubeMarsConfig& config, Wiring wiring);

  std::optional<can_frame> receive(const can_frame& frame, std::int64_t now_ns) override;
  std::int64_t next_own_ns() const override;
  std::optional<can_frame> act(std::int64_t now_ns) override;

 private:
  bool v3() const { return config_.dialect == Dialect::v3; }
  can_frame status() const;
  bool obey(const can_frame& frame);
  void obey_current(double current_A);
  void obey_brake(double current_A);
  void obey_mit(std::uint64_t bits);

  CubeMarsConfig config_;
  Wiring wiring_;
  std::int64_t timeout_ns_;
  bool commanded_ = false;
  std::int64_t last_frame_ns_ = 0;
  std::int64_t next_status_ns_ = 0;
};

}  // namespace sandhopper::bench
