#include <span>
#include <string_view>
#include <system_error>

#include "firmware/log/append_file.hpp"
#include "firmware/log/candump.hpp"
#include "firmware/log/log_recovery.hpp"
#include "firmware/log/mapped_file.hpp"
#include "firmware/log/mcap_format.hpp"

namespace sandhopper {
namespace {

// A line as the writer makes it: a frame, or text that CAN tools skip. A CR before the end is accepted.
bool is_sound(std::string_view line, LogRecovery& result) {
  if (line.find('\0') != std::string_view::npos) return false;
  if (const std::uint64_t lost = frames_lost_in(line); lost > 0) {
    ++result.gaps;
    result.lost_in_gaps += lost;
  }
  if (!line.starts_with('(')) return line.empty() || line == "\r" || line.starts_with('#');
  try {
    const auto frame = parse_candump(line);
    if (result.saved() == 0) result.first_ns = frame->frame.time_ns;
    result.last_ns = frame->frame.time_ns;
    ++result.topics[std::string(frame->interface)].saved;
    return true;
  } catch (const CandumpError&) {
    return false;
  }
}

}  // namespace

LogRecovery recover_candump(const std::filesystem::path& from, const std::filesystem::path& to) {
  const MappedFile file(from);
  const std::string_view text = mcap::text_of(file.bytes());
  LogRecovery result;
  result.file_bytes = text.size();
  std::string sound;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string_view::npos) {
      result.cut_at = start;
      result.unreadable_bytes += text.size() - start;
      break;
    }
    const std::string_view line = text.substr(start, end - start);
    if (is_sound(line, result)) {
      sound.append(line).append("\n");
    } else {
      result.damage.push_back({start, end + 1, "a line that is no frame"});
      result.unreadable_bytes += end + 1 - start;
    }
    start = end + 1;
  }
  if (result.saved() == 0)
    throw CandumpError(from.string() + ": there is no whole line with a CAN frame in it");
  result.whole = !result.cut_at && result.damage.empty();
  if (result.whole) return result;
  AppendFile copy(to);
  copy.append(std::as_bytes(std::span(sound)));
  copy.close();
  return result;
}

}  // namespace sandhopper
