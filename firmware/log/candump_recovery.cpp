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

// Counts a frame, or a comment on lost ones. False if the line is neither, nor blank.
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

// The interface of a damaged line, "(1.5) can0 00", if so much of it can be read.
std::string interface_of(std::string_view line) {
  const auto begin = line.find(") ");
  if (!line.starts_with('(') || begin == std::string_view::npos) return "(unknown)";
  const auto end = line.find_first_of(std::string_view(" \0", 2), begin + 2);
  return end == std::string_view::npos ? "(unknown)" : std::string(line.substr(begin + 2, end - begin - 2));
}

// Counts what a damaged line loses. Zeros replace the text that a power cut kept from the disk: behind them a
// whole frame may stand, and more frames than the one they cut may be lost.
std::string_view take_damaged(std::string_view line, std::uint64_t start, LogRecovery& result) {
  const auto first_zero = line.find('\0');
  const bool has_zeros = first_zero != std::string_view::npos;
  result.loses_at_least |= has_zeros;
  if (has_zeros) {
    const auto last_zero = line.rfind('\0');
    const auto behind = line.substr(last_zero + 1);
    const bool saved = !behind.empty() && is_sound(behind, result);
    const bool cut = first_zero > 0 || (!saved && !behind.empty());
    if (cut) ++result.topics[interface_of(line)].lost;
    result.damage.push_back({start + first_zero, start + last_zero + 1,
                             cut ? "zeros within a frame, as after a power cut: at least that frame is lost"
                                 : "zeros, as after a power cut: frames may be lost"});
    return saved ? behind : std::string_view{};
  }
  if (line.starts_with('(')) ++result.topics[interface_of(line)].lost;
  result.damage.push_back({start, start + line.size() + 1, "a line that is no frame"});
  return {};
}

// Length of the text that the file repeats to its end, as after `cat trace >> trace`; the whole length if it
// does not. Times rise, so a trace never repeats by itself.
std::size_t length_of_one_copy(std::string_view text) {
  const std::string_view first_line = text.substr(0, text.find('\n') + 1);
  if (first_line.empty()) return text.size();
  for (auto at = text.find(first_line, first_line.size()); at != std::string_view::npos;
       at = text.find(first_line, at + 1))
    if (text.substr(at) == text.substr(0, text.size() - at)) return at;
  return text.size();
}

}  // namespace

LogRecovery recover_candump(const std::filesystem::path& from, const std::filesystem::path& to) {
  const MappedFile file(from);
  const std::string_view whole_text = mcap::text_of(file.bytes());
  const std::string_view text = whole_text.substr(0, length_of_one_copy(whole_text));
  LogRecovery result;
  result.file_bytes = whole_text.size();
  if (!text.empty()) result.copies = (whole_text.size() + text.size() - 1) / text.size();
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
      const auto saved = take_damaged(line, start, result);
      if (!saved.empty()) sound.append(saved).append("\n");
      result.unreadable_bytes += line.size() + 1 - saved.size();
    }
    start = end + 1;
  }
  if (result.saved() == 0)
    throw CandumpError(from.string() + ": there is no whole line with a CAN frame in it");
  result.whole = !result.cut_at && result.damage.empty() && result.copies <= 1;
  if (result.whole) return result;
  AppendFile copy(to);
  copy.append(std::as_bytes(std::span(sound)));
  copy.close();
  return result;
}

}  // namespace sandhopper
