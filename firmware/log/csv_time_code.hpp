#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

// Time codes of cameras (SMPTE ST 12-1): hours, minutes, seconds and a number of frames. Other counts of
// parts of a second, such as milliseconds that are not filled with zeros, have the same form.
namespace sandhopper {

struct TimeCode {
  int hours = 0, minutes = 0, seconds = 0, frames = 0;
  bool drops_frames = false;  // 10:00:00;00: the numbers of some frames are passed over
};

// Reads 10:00:00:12 and 10:00:00;12; empty for another text.
std::optional<TimeCode> time_code_in(std::string_view text);

// Frames are numbered by the next whole number of frames per second, 30 for 29.97. A code that drops frames
// passes over two numbers of 30 in each minute but every tenth.
double seconds_of(const TimeCode& code, double frames_per_s);

// The largest number of a frame, for comparison with the stated number of frames per second.
class FrameCounts {
 public:
  void take(const TimeCode& code, std::uint64_t line);
  // Text of a contradiction; empty without one. A recording may skip frames, so a largest number that is too
  // small counts only if each frame follows on the one before, over three seconds.
  std::string doubt(double frames_per_s) const;
  std::uint64_t line() const { return line_; }  // of the largest number

 private:
  std::optional<TimeCode> last_{};
  int largest_ = 0;
  std::uint64_t line_ = 0;
  std::uint64_t seconds_ = 0;  // begun within the recording
  bool is_without_gap_ = true;
};

}  // namespace sandhopper
