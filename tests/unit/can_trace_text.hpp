#pragma once
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tools/trial/can_replay.hpp"

namespace sandhopper::trace {

constexpr double kMs = 1e-3;
constexpr double kReply = 0.26e-3;  // seconds after its command

// Makes `candump -L` text line by line.
class TraceText {
 public:
  explicit TraceText(double begin_s = 1.7e9) : begin_s_(begin_s) {}

  TraceText& line(double t_s, const std::string& frame, const std::string& interface = "can0") {
    const auto t_ns = static_cast<std::int64_t>(begin_s_) * 1'000'000 + std::llround(t_s * 1e6);
    text_ += fmt::format("({}.{:06}) {} {}\n", t_ns / 1'000'000, t_ns % 1'000'000, interface, frame);
    return *this;
  }
  TraceText& raw(const std::string& text) {
    text_ += text;
    return *this;
  }
  // A command of the MIT dialect without torque; `position`: code of its position field.
  TraceText& command(double t_s, int drive, unsigned position = 0x8000) {
    return line(t_s, fmt::format("{:03X}#{:04X}8000A3199800", drive, position));
  }
  TraceText& reply(double t_s, int drive, unsigned position = 0x8000, int id = 0x11) {
    return line(t_s, fmt::format("{:03X}#{:02X}{:04X}7FF83846{:02X}", id, drive, position, 0));
  }

  const std::string& text() const { return text_; }

  // Writes the text to a file of this process, replays it and removes it.
  CanReplayResult replay(const CanReplaySetup& setup = {}) const {
    const auto file = std::filesystem::temp_directory_path() / fmt::format("trace_{}.log", ::getpid());
    std::ofstream(file, std::ios::binary) << text_;
    auto result = replay_can(file, setup);
    std::filesystem::remove(file);
    return result;
  }
  TraceReport report(const CanReplaySetup& setup = {}) const { return replay(setup).trace; }

 private:
  double begin_s_;
  std::string text_;
};

inline CanReplaySetup setup_of(int can_id, int master_id = 17) {
  CanReplaySetup setup;
  setup.config.motor[0].can_id = can_id;
  setup.config.motor[0].master_id = master_id;
  return setup;
}

inline std::vector<std::string> kinds(const TraceReport& report) {
  std::vector<std::string> out;
  for (const auto& finding : report.findings) out.push_back(finding.kind);
  return out;
}

// The text of the finding of this kind; empty if there is none.
inline std::string text_of(const TraceReport& report, const std::string& kind) {
  for (const auto& finding : report.findings)
    if (finding.kind == kind) return finding.text + " -> " + finding.cure;
  return "";
}

// Path of a file among the data beside this repository. Prints a warning and returns nothing if it is missing
// or empty.
inline std::optional<std::filesystem::path> field_input(const std::string& name) {
  const auto file =
      std::filesystem::path(SANDHOPPER_SOURCE_DIR).parent_path() / "shared/data/field_inputs" / name;
  std::error_code error;
  if (std::filesystem::file_size(file, error) > 0 && !error) return file;
  std::printf("*** SKIPPED: %s is not there, or is empty; put the recordings beside this repository ***\n",
              file.c_str());
  return std::nullopt;
}

}  // namespace sandhopper::trace
