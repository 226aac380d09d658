#pragma once
#include <cstdint>
#include <deque>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"

// The text of a recording that another program wrote, line by line in UTF-8.
namespace sandhopper {

enum class TextEncoding : std::uint8_t { utf8, utf16_le, utf16_be, windows_1252 };
template <>
struct EnumNames<TextEncoding> {
  static constexpr std::array<std::string_view, 4> value{"utf-8", "utf-16", "utf-16-be", "windows-1252"};
};

// A file that holds no text at all: "an Excel file (.xlsx)", and how to make a table of it.
struct BinaryFormat {
  std::string_view name;
  std::string_view cure;
};
// The name of a binary format, from the first bytes of the file (magic numbers of the formats'
// specifications); empty for a text.
std::optional<BinaryFormat> binary_format_of(std::string_view first_bytes);

// A text that is no table, by its first line that is not empty: a page, JSON, a name before every value.
struct OtherText {
  std::string name;
  std::string cure;
};
std::optional<OtherText> other_text_of(std::string_view line);

// UTF-16 by its byte order mark or by every second byte being 0, Windows-1252 where the bytes are no UTF-8,
// else UTF-8. The last character may be cut.
TextEncoding encoding_of(std::string_view bytes);
std::string utf8_from(std::string_view bytes, TextEncoding encoding);

// Lines of a stream without their line ends (\n, \r\n or \r) and without a byte order mark, in UTF-8. The
// first `kAhead` lines can be looked at before they are taken.
class TextLines {
 public:
  static constexpr std::size_t kAhead = 400;

  explicit TextLines(std::istream& in, std::optional<TextEncoding> encoding = std::nullopt);

  TextEncoding encoding() const { return encoding_; }
  const std::deque<std::string>& ahead() const { return ahead_; }
  std::string_view first_bytes() const { return first_bytes_; }  // as they stand in the file
  bool next(std::string& line);                                  // false at the end
  bool last_is_ended() const { return last_is_ended_; }          // the last line that was read has its end

 private:
  bool read(std::string& line);
  bool raw_line(std::string& line);
  void join_broken_names();

  std::istream& in_;
  TextEncoding encoding_;
  std::string held_;  // bytes that were read to look at them, or the whole of a UTF-16 text
  std::size_t at_ = 0;
  std::string first_bytes_;
  std::deque<std::string> ahead_;
  bool is_old_mac_ = false;  // \r alone ends a line
  bool last_is_ended_ = true;
};

}  // namespace sandhopper
