#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "config/fields.hpp"
#include "drivers/samples.hpp"
#include "firmware/fault.hpp"

namespace sandhopper {

// State of the robot that is kept over restarts of hopperd and of the computer.
struct KeptState {
  std::string boot_id;              // boot in which it was written
  std::int64_t boottime_ns = 0;     // CLOCK_BOOTTIME when it was written
  std::int64_t realtime_ns = 0;     // CLOCK_REALTIME when it was written
  bool clock_synchronised = false;  // true if realtime_ns may be compared with that of another boot
  bool closed = false;              // written at the end of a run that ended in order
  double period_s = 1.0;            // a run that did not end in order may have continued this long after the
                                    // state was written
  std::array<double, kMotorCount> winding_C{};
  std::array<double, kMotorCount> housing_C{};
  std::array<double, kMotorCount> position_rad{};
  bool positions_known = false;
  std::uint32_t touchdowns = 0;  // since the leg was inspected
  Fault fault = Fault::none;     // not yet disarmed

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor&& visit) {
    visit("boot_id", self.boot_id);
    visit("boottime_ns", self.boottime_ns);
    visit("realtime_ns", self.realtime_ns);
    visit("clock_synchronised", self.clock_synchronised);
    visit("closed", self.closed);
    visit("period_s", self.period_s, Range{0.0, 60.0});
    visit("winding_C", self.winding_C, Range{-100.0, 1000.0});
    visit("housing_C", self.housing_C, Range{-100.0, 1000.0});
    visit("position_rad", self.position_rad, Range{-1e6, 1e6});
    visit("positions_known", self.positions_known);
    visit("touchdowns", self.touchdowns);
    visit("fault", self.fault);
  }
};

// A state as file content: one line with format, version, length and CRC-32 of the rest, then TOML.
std::string state_text(const KeptState& state);

struct StateRead {
  std::optional<KeptState> state;
  bool there = false;   // the file exists
  std::string problem;  // reason why there is no state
};
StateRead state_from_text(std::string_view text);
StateRead read_state_file(const std::filesystem::path& file);

// Writes the file atomically: after a power cut there is the old file or the new one. Throws
// std::system_error.
void write_state_file(const std::filesystem::path& file, const KeptState& state);

// Files of the robot's state. `boot`: for this boot of the computer, in memory, written often. `lasting`: for
// all boots, written seldom.
struct StatePlaces {
  std::filesystem::path boot;
  std::filesystem::path lasting;
};
// Files in `directory` if it is not empty, otherwise in systemd's folders ($RUNTIME_DIRECTORY,
// $STATE_DIRECTORY), otherwise in /run/sandhopper and /var/lib/sandhopper.
StatePlaces state_places(const std::string& directory);

}  // namespace sandhopper
