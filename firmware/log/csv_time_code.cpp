#include "firmware/log/csv_time_code.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "firmware/log/csv_cells.hpp"

namespace sandhopper {

std::optional<TimeCode> time_code_in(std::string_view text) {
  std::array<int, 4> parts{};
  TimeCode code;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parts[i]);
    const auto digits = static_cast<std::size_t>(end - text.data());
    if (error != std::errc{} || parts[i] < 0 || text.front() == '-') return std::nullopt;
    text.remove_prefix(digits);
    if (i + 1 == parts.size()) break;
    const bool drops = i == 2 && text.starts_with(';');
    if (!text.starts_with(':') && !drops) return std::nullopt;
    code.drops_frames = drops;
    text.remove_prefix(1);
  }
  if (!text.empty() || parts[1] > 59 || parts[2] > 59) return std::nullopt;
  code.hours = parts[0], code.minutes = parts[1], code.seconds = parts[2], code.frames = parts[3];
  return code;
}

double seconds_of(const TimeCode& code, double frames_per_s) {
  const double numbered = std::ceil(frames_per_s);
  const double minutes = 60.0 * code.hours + code.minutes;
  double frames = (60.0 * minutes + code.seconds) * numbered + code.frames;
  if (code.drops_frames) frames -= 2.0 * numbered / 30.0 * (minutes - std::floor(minutes / 10.0));
  return frames / frames_per_s;
}

void FrameCounts::take(const TimeCode& code, std::uint64_t line) {
  if (line_ == 0 || code.frames > largest_) largest_ = code.frames, line_ = line;
  if (last_) {
    const bool is_next_second = code.seconds != last_->seconds;
    seconds_ += is_next_second;
    is_without_gap_ &=
        is_next_second ? code.frames == 0 || code.drops_frames : code.frames == last_->frames + 1;
  }
  last_ = code;
}

std::string FrameCounts::doubt(double frames_per_s) const {
  constexpr std::uint64_t kEnoughSeconds = 3;
  const double numbered = std::ceil(frames_per_s);
  if (!last_) return "";
  const bool too_many = largest_ >= numbered;
  const bool too_few = is_without_gap_ && seconds_ >= kEnoughSeconds && largest_ + 1 < numbered;
  if (!too_many && !too_few) return "";
  return "its frames are numbered up to " + std::to_string(largest_) +
         ", and [format] states frames_per_s = " + shown_number(frames_per_s);
}

}  // namespace sandhopper
