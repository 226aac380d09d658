#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace sandhopper {

// Error code of a CubeMars drive: byte 7 of an MIT reply and of a status frame. CubeMars AK manual V1.0.18,
// AKA manual V3.0.0. Older drivers (TMotorCANControl) name 6 "phase current imbalance".
inline constexpr std::array<std::string_view, 8> kDriveErrors{
    "none",    "motor over-temperature",  "over-current", "over-voltage", "under-voltage",
    "encoder", "driver over-temperature", "stall"};

constexpr std::string_view drive_error_name(std::uint8_t code) noexcept {
  return code < kDriveErrors.size() ? kDriveErrors[code] : "unknown code";
}

}  // namespace sandhopper
