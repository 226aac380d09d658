#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "firmware/log/candump.hpp"
#include "tools/trial/trace/time_digits.hpp"

// A recorded CAN trace. It is read completely, so that both directions can be examined together.
namespace sandhopper::trace {

struct Frame {
  std::int64_t time_ns = 0;
  std::uint64_t line = 0;  // line of the file
  std::uint32_t id = 0;    // with the flags of linux/can.h
  std::uint16_t interface = 0;
  std::uint8_t length = 0;
  CanDirection direction = CanDirection::unknown;
  std::array<std::uint8_t, 8> data{};

  bool is_error() const noexcept { return (id & 0x20000000U) != 0; }
  bool is_remote() const noexcept { return !is_error() && (id & 0x40000000U) != 0; }
  bool is_extended() const noexcept { return !is_error() && (id & 0x80000000U) != 0; }
};

// Lines that are not a classic CAN frame.
struct BadLines {
  std::uint64_t count = 0;
  std::uint64_t first_line = 0;
  std::string first;  // the reader's message
};

// CAN FD frames of one identifier.
struct FdFrames {
  std::uint64_t count = 0;
  std::uint8_t longest = 0;  // data bytes
};

struct Trace {
  std::string file;
  std::vector<std::string> interfaces;
  std::vector<Frame> frames;  // in the order of the file
  BadLines unreadable;        // not counting the last line
  bool last_line_torn = false;
  BadLines passed_over;          // neither frame, comment nor blank; every CAN tool skips them
  std::uint64_t zero_bytes = 0;  // zero bytes, as after a power cut
  std::uint64_t fd_frames = 0;   // CAN FD and CAN XL frames, which are skipped
  std::map<std::uint32_t, FdFrames> fd_by_id{};  // by identifier with the flags of linux/can.h
  BadLines losses{};                             // lines in which the recorder reports that it lost frames
  std::uint64_t frames_in_losses = 0;            // sum of the numbers in these lines
  BadLines spreadsheet_numbers{};                // data that a spreadsheet turned into numbers
  TimeDigits digits{};
  std::uint64_t lost_by_recorder = 0;  // according to its own comments, "# 12 frames lost: …"
};

// Reads the frames of interface `bus`, or of all interfaces if it is empty. Unreadable lines are counted and
// skipped. Throws std::system_error if the file cannot be opened.
Trace read_trace(const std::filesystem::path& file, const std::string& bus = {},
                 const std::function<void(std::uint64_t frames)>& progress = {});

}  // namespace sandhopper::trace
