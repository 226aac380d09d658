#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "firmware/event.hpp"
#include "firmware/records.hpp"
#include "firmware/sensor_frame.hpp"

namespace sandhopper {

// Record of one cycle: its input, output and events.
struct FreezeCycle {
  SensorFrame frame{};
  StepOutput output{};
  std::uint32_t event_count = 0;
  std::array<Event, 8> events{};  // the most that a cycle can have (Controller::events)

  std::span<const Event> seen_events() const noexcept {
    return {events.data(), std::min<std::size_t>(event_count, events.size())};
  }
};
static_assert(std::is_trivially_copyable_v<FreezeCycle>);

}  // namespace sandhopper
