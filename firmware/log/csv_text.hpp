#pragma once
#include <cstdint>
#include <deque>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/fields.hpp"

// Text of a recording of another program, line by line, converted to UTF-8.
namespace sandhopper {

enum class TextEncoding : std::uint8_t {
  utf8,
  utf16_le,
  utf16_be,
  windows_1252,
  windows_1251,  // Cyrillic
  mac_roman,
  utf32_le,
  utf32_be
};
template <>
struct EnumNames<TextEncoding> {
  static constexpr std::array<std::string_view, 8> value{
      "utf-8", "utf-16", "utf-16-be", "windows-1252", "windows-1251", "mac-roman", "utf-32", "utf-32-be"};
};
// True for more than one byte per character of ASCII.
constexpr bool is_wide(TextEncoding encoding) {
  return encoding == TextEncoding::utf16_le || encoding == TextEncoding::utf16_be ||
         encoding == TextEncoding::utf32_le || encoding == TextEncoding::utf32_be;
}

// A file that is not text, such as "an Excel file (.xlsx)", and the way to make a table of it.
struct BinaryFormat {
  std::string_view name;
  std::string_view cure;
};
// Binary format recognised from the file's first bytes (magic numbers in the formats' specifications). Empty
// for a text.
std::optional<BinaryFormat> binary_format_of(std::string_view first_bytes);

// A text that is no table, recognised from its first non-empty line: a web page, JSON, names before every
// value, or a pointer to a recording that was not fetched (git LFS, git-annex, DVC).
struct OtherText {
  std::string name;
  std::string cure;
};
std::optional<OtherText> other_text_of(std::string_view line);

// UTF-16 or UTF-32 if there is a byte order mark or every second byte, or three of four, are 0; a code page
// (csv_code_pages.hpp) if the bytes are not valid UTF-8; otherwise UTF-8. The last character may be
// incomplete.
TextEncoding encoding_of(std::string_view bytes);
std::string utf8_from(std::string_view bytes, TextEncoding encoding);

// Lines of a stream in UTF-8, without line ends (\n, \r\n or \r) and without a byte order mark. The first
// `ahead` lines can be read in advance.
class TextLines {
 public:
  static constexpr std::size_t kAhead = 400;

  explicit TextLines(std::istream& in, std::optional<TextEncoding> encoding = std::nullopt,
                     std::size_t ahead = kAhead);

  TextEncoding encoding() const { return encoding_; }
  const std::deque<std::string>& ahead() const { return ahead_; }
  std::string_view first_bytes() const { return first_bytes_; }  // unchanged bytes of the file
  bool next(std::string& line);                                  // false at the end
  bool last_is_ended() const { return last_is_ended_; }          // true if the last line read has a line end

 private:
  bool read(std::string& line);
  bool raw_line(std::string& line);
  void join_broken_names();

  std::istream& in_;
  TextEncoding encoding_;
  std::string held_;  // bytes read in advance, or the whole of a UTF-16 or UTF-32 text
  std::size_t at_ = 0;
  std::string first_bytes_;
  std::deque<std::string> ahead_;
  bool is_old_mac_ = false;  // \r alone ends a line
  bool last_is_ended_ = true;
};

// Content other than a table, by the first bytes or the first non-empty line.
std::optional<OtherText> other_content_of(const TextLines& lines);

}  // namespace sandhopper
