#include "firmware/log/candump.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <system_error>

namespace sandhopper {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x80000000;
constexpr std::uint32_t kRemoteFlag = 0x40000000;
constexpr std::uint32_t kErrorFlag = 0x20000000;
constexpr std::uint32_t kExtendedMask = 0x1FFFFFFF;
constexpr std::uint32_t kStandardMask = 0x7FF;
constexpr std::int64_t kNanoseconds = 1'000'000'000;
constexpr std::size_t kBufferBytes = 65'536;

void append_hex(std::string& text, std::uint32_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4)
    text += "0123456789ABCDEF"[(value >> shift) & 0xF];
}

void append_decimal(std::string& text, std::int64_t value, std::size_t digits) {
  const std::string number = std::to_string(value);
  text.append(digits > number.size() ? digits - number.size() : 0, '0');
  text += number;
}

void append_line(std::string& text, const CandumpFrame& frame, std::string_view interface,
                 CandumpFormat format) {
  text += '(';
  append_decimal(text, frame.time_ns / kNanoseconds, 1);
  text += '.';
  const std::int64_t fraction_ns = frame.time_ns % kNanoseconds;
  if (format.decimals == 6) {
    append_decimal(text, fraction_ns / 1'000, 6);
  } else {
    append_decimal(text, fraction_ns, 9);
  }
  text += ") ";
  text += interface;
  text += ' ';
  if ((frame.id & kErrorFlag) != 0) {
    append_hex(text, frame.id & (kErrorFlag | kExtendedMask), 8);
  } else if ((frame.id & kExtendedFlag) != 0) {
    append_hex(text, frame.id & kExtendedMask, 8);
  } else {
    append_hex(text, frame.id & kStandardMask, 3);
  }
  text += '#';
  const std::size_t length = std::min<std::size_t>(frame.length, frame.data.size());
  if ((frame.id & kRemoteFlag) != 0) {
    text += 'R';
    if (length > 0) text += static_cast<char>('0' + length);
  } else {
    for (std::size_t i = 0; i < length; ++i) append_hex(text, frame.data[i], 2);
  }
  if (!format.direction) return;
  if (frame.direction == CanDirection::received) text += " R";
  if (frame.direction == CanDirection::sent) text += " T";
}

[[noreturn]] void bad(std::string_view what, std::string_view part) {
  throw CandumpError(std::string(what) + ": \"" + std::string(part) + '"');
}

std::string_view take_token(std::string_view& text) {
  const auto start = std::min(text.find_first_not_of(" \t"), text.size());
  text.remove_prefix(start);
  const std::string_view token = text.substr(0, text.find_first_of(" \t"));
  text.remove_prefix(token.size());
  return token;
}

std::int64_t parse_time(std::string_view token) {
  const char* const end = token.data() + token.size();
  std::int64_t seconds = 0;
  if (token.starts_with('-')) bad("a negative time", token);  // -0.3 would be read as 0.3
  auto [place, error] = std::from_chars(token.data(), end, seconds);
  if (error != std::errc{} || seconds < 0 || seconds > INT64_MAX / kNanoseconds - 1) bad("not a time", token);
  std::int64_t fraction_ns = 0;
  if (place != end) {
    std::int64_t unit_ns = kNanoseconds;
    if (*place++ != '.') bad("not a time", token);
    // Old versions of asc2log write a full second like this (can-utils pull request 286).
    if (std::string_view(place, static_cast<std::size_t>(end - place)) == "1000000")
      return (seconds + 1) * kNanoseconds;
    for (; place != end; ++place) {
      if (*place < '0' || *place > '9') bad("not a time", token);
      unit_ns /= 10;
      fraction_ns += unit_ns * (*place - '0');
    }
  }
  return seconds * kNanoseconds + fraction_ns;
}

std::uint32_t parse_id(std::string_view digits, std::string_view token) {
  std::uint32_t id = 0;
  const auto [place, error] = std::from_chars(digits.data(), digits.data() + digits.size(), id, 16);
  if (error != std::errc{} || place != digits.data() + digits.size()) bad("not a CAN identifier", token);
  if (digits.size() == 3) {
    if (id > kStandardMask) bad("a standard identifier is at most 7FF", token);
    return id;
  }
  if (digits.size() != 8) bad("an identifier has three digits or eight", token);
  if ((id & kErrorFlag) != 0) return id & (kErrorFlag | kExtendedMask);
  if (id > kExtendedMask) bad("an extended identifier is at most 1FFFFFFF", token);
  return id | kExtendedFlag;
}

void parse_data(std::string_view digits, std::string_view token, CandumpFrame& frame) {
  while (!digits.empty() && digits.front() != '_') {  // _X: the raw length code of classic frames, not needed
    if (digits.front() == '.') {
      digits.remove_prefix(1);
      continue;
    }
    if (frame.length == frame.data.size()) bad("more than eight data bytes", token);
    std::uint8_t value = 0;
    const auto [place, error] =
        std::from_chars(digits.data(), digits.data() + std::min<std::size_t>(2, digits.size()), value, 16);
    if (error != std::errc{} || place != digits.data() + 2) bad("not pairs of hexadecimal digits", token);
    frame.data[frame.length++] = value;
    digits.remove_prefix(2);
  }
}

void parse_frame(std::string_view token, CandumpFrame& frame) {
  const auto mark = token.find('#');
  if (mark == std::string_view::npos) bad("no '#' between identifier and data", token);
  frame.id = parse_id(token.substr(0, mark), token);
  std::string_view data = token.substr(mark + 1);
  if (data.starts_with('#')) bad("a CAN FD frame; only classic CAN is supported", token);
  if (!data.starts_with('R')) {
    parse_data(data, token, frame);
    return;
  }
  frame.id |= kRemoteFlag;
  data.remove_prefix(1);
  if (data.empty() || data.front() == '_') return;
  if (data.front() < '0' || data.front() > '8') bad("not a remote request's length", token);
  frame.length = static_cast<std::uint8_t>(data.front() - '0');
}

}  // namespace

std::string format_candump(const CandumpFrame& frame, std::string_view interface, CandumpFormat format) {
  std::string text;
  append_line(text, frame, interface, format);
  return text;
}

std::optional<CandumpLine> parse_candump(std::string_view line) {
  if (!line.starts_with('(')) return std::nullopt;
  if (line.ends_with('\r')) line.remove_suffix(1);
  const auto close = line.find(')');
  if (close == std::string_view::npos) bad("no ')' after the time", line);
  CandumpLine result;
  result.frame.time_ns = parse_time(line.substr(1, close - 1));
  std::string_view rest = line.substr(close + 1);
  result.interface = take_token(rest);
  const std::string_view token = take_token(rest);
  if (token.empty()) bad("no frame; expected \"(seconds) interface ID#DATA\"", line);
  parse_frame(token, result.frame);
  for (auto extra = take_token(rest); !extra.empty(); extra = take_token(rest)) {
    if (extra == "R") result.frame.direction = CanDirection::received;
    if (extra == "T") result.frame.direction = CanDirection::sent;
  }
  return result;
}

std::uint64_t frames_lost_in(std::string_view line) {
  std::uint64_t frames = 0;
  if (!line.starts_with("# ")) return 0;
  line.remove_prefix(2);
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), frames);
  const std::string_view rest = line.substr(static_cast<std::size_t>(end - line.data()));
  return error == std::errc{} && rest.starts_with(" frames lost: ") ? frames : 0;
}

CandumpWriter::CandumpWriter(const std::filesystem::path& file, CandumpFormat format, const CandumpDisk& disk)
    : file_(file, disk.reserve_bytes, disk.calls), format_(format), keep_going_(disk.keep_going) {
  buffer_.reserve(kBufferBytes + 256);
}

void CandumpWriter::write(const CandumpFrame& frame, std::string_view interface) {
  append_line(buffer_, frame, interface, format_);
  buffer_ += '\n';
  ++frames_in_buffer_;
  if (buffer_.size() >= kBufferBytes) flush();
}

void CandumpWriter::comment(std::string_view text) {
  buffer_ += "# ";
  buffer_ += text;
  buffer_ += '\n';
}

void CandumpWriter::comment_lost(std::uint64_t frames, std::string_view why) {
  comment(std::to_string(frames) + " frames lost: " + std::string(why));
  said_in_buffer_ += frames;
}

void CandumpWriter::flush() {
  if (buffer_.empty() && unsaid_ == 0) return;
  std::string text;
  if (unsaid_ > 0) text = "# " + std::to_string(unsaid_) + " frames lost: they could not be written\n";
  text += buffer_;
  try {
    file_.append(std::as_bytes(std::span(text)));
    unsaid_ = 0;
    error_.clear();
  } catch (const std::system_error& error) {
    if (!keep_going_) throw;
    lost_ += frames_in_buffer_;
    unsaid_ += frames_in_buffer_ + said_in_buffer_;
    error_ = error.what();
  }
  buffer_.clear();
  frames_in_buffer_ = said_in_buffer_ = 0;
}

void CandumpWriter::close() {
  if (!file_.is_open()) return;
  flush();
  file_.open_reserve();
  flush();
  file_.close();
}

CandumpReader::CandumpReader(const std::filesystem::path& file) : name_(file.string()), in_(file) {
  if (!in_) throw std::system_error(errno, std::generic_category(), name_);
}

bool CandumpReader::next(CandumpFrame& frame, std::string_view& interface) {
  while (std::getline(in_, line_)) {
    ++line_number_;
    try {
      const auto line = parse_candump(line_);
      if (!line) continue;
      frame = line->frame;
      interface = line->interface;
      return true;
    } catch (const CandumpError& error) {
      throw CandumpError(name_ + ':' + std::to_string(line_number_) + ": " + error.what());
    }
  }
  return false;
}

}  // namespace sandhopper
