#include "firmware/log/csv_code_pages.hpp"

#include <algorithm>
#include <array>

namespace sandhopper {
namespace {

// Five bytes have no character in Windows-1252. As control characters they would reach a terminal.
constexpr char32_t kNoCharacter = 0xFFFD;

// Characters 0x80 to 0x9F of Windows-1252; the others equal Latin-1. Source: WHATWG Encoding Standard, index
// windows-1252.
constexpr std::u32string_view kWindows1252 =
    U"\u20AC\uFFFD\u201A\u0192\u201E\u2026\u2020\u2021\u02C6\u2030\u0160\u2039\u0152\uFFFD\u017D\uFFFD"
    U"\uFFFD\u2018\u2019\u201C\u201D\u2022\u2013\u2014\u02DC\u2122\u0161\u203A\u0153\uFFFD\u017E\u0178";

// Characters 0x80 to 0xBF of Windows-1251; from 0xC0 on stand the letters from U+0410 on. Source: as above.
constexpr std::u32string_view kWindows1251 =
    U"\u0402\u0403\u201A\u0453\u201E\u2026\u2020\u2021\u20AC\u2030\u0409\u2039\u040A\u040C\u040B\u040F"
    U"\u0452\u2018\u2019\u201C\u201D\u2022\u2013\u2014\uFFFD\u2122\u0459\u203A\u045A\u045C\u045B\u045F"
    U"\u00A0\u040E\u045E\u0408\u00A4\u0490\u00A6\u00A7\u0401\u00A9\u0404\u00AB\u00AC\u00AD\u00AE\u0407"
    U"\u00B0\u00B1\u0406\u0456\u0491\u00B5\u00B6\u00B7\u0451\u2116\u0454\u00BB\u0458\u0405\u0455\u0457";

// Characters 0x80 to 0xFF of Mac Roman. Source: WHATWG Encoding Standard, index macintosh.
constexpr std::u32string_view kMacRoman =
    U"\u00C4\u00C5\u00C7\u00C9\u00D1\u00D6\u00DC\u00E1\u00E0\u00E2\u00E4\u00E3\u00E5\u00E7\u00E9\u00E8"
    U"\u00EA\u00EB\u00ED\u00EC\u00EE\u00EF\u00F1\u00F3\u00F2\u00F4\u00F6\u00F5\u00FA\u00F9\u00FB\u00FC"
    U"\u2020\u00B0\u00A2\u00A3\u00A7\u2022\u00B6\u00DF\u00AE\u00A9\u2122\u00B4\u00A8\u2260\u00C6\u00D8"
    U"\u221E\u00B1\u2264\u2265\u00A5\u00B5\u2202\u2211\u220F\u03C0\u222B\u00AA\u00BA\u03A9\u00E6\u00F8"
    U"\u00BF\u00A1\u00AC\u221A\u0192\u2248\u2206\u00AB\u00BB\u2026\u00A0\u00C0\u00C3\u00D5\u0152\u0153"
    U"\u2013\u2014\u201C\u201D\u2018\u2019\u00F7\u25CA\u00FF\u0178\u2044\u20AC\u2039\u203A\uFB01\uFB02"
    U"\u2021\u00B7\u201A\u201E\u2030\u00C2\u00CA\u00C1\u00CB\u00C8\u00CD\u00CE\u00CF\u00CC\u00D3\u00D4"
    U"\uF8FF\u00D2\u00DA\u00DB\u00D9\u0131\u02C6\u02DC\u00AF\u02D8\u02D9\u02DA\u00B8\u02DD\u02DB\u02C7";

char32_t character_of(unsigned byte, TextEncoding page) {
  if (byte < 0x80) return byte;
  if (page == TextEncoding::mac_roman) return kMacRoman[byte - 0x80];
  if (page == TextEncoding::windows_1251)
    return byte < 0xC0 ? kWindows1251[byte - 0x80] : static_cast<char32_t>(0x0410 + byte - 0xC0);
  return byte < 0xA0 ? kWindows1252[byte - 0x80] : byte;
}

unsigned byte_at(std::string_view bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

// Number of bytes of the UTF-8 character that begins with `first`; 0 if none does.
std::size_t length_of_character(unsigned first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  if (first >= 0xF0 && first < 0xF5) return 4;
  return 0;
}

bool is_small(unsigned c) { return c >= 'a' && c <= 'z'; }
bool is_ascii_letter(unsigned c) { return is_small(c | 0x20); }

// Letters of Windows-1251: capitals, then small ones.
bool is_cyrillic_capital(unsigned c) { return (c >= 0xC0 && c < 0xE0) || c == 0xA8; }
bool is_cyrillic_small(unsigned c) { return c >= 0xE0 || c == 0xB8; }

// A word of two letters or more with a capital at most at its beginning, or all in capitals. Bytes 0xFF of
// erased flash memory are no word.
bool is_cyrillic_word(std::string_view word) {
  if (word.size() < 2 || word.find_first_not_of('\xFF') == std::string_view::npos) return false;
  const auto all = [](std::string_view part, bool (*is)(unsigned)) {
    return std::ranges::all_of(part, [&](char c) { return is(static_cast<unsigned char>(c)); });
  };
  const unsigned first = byte_at(word, 0);
  return all(word, is_cyrillic_capital) ||
         ((is_cyrillic_capital(first) || is_cyrillic_small(first)) && all(word.substr(1), is_cyrillic_small));
}

// True if a capital or sign of Windows-1252 that is a small letter in Mac Roman follows on a small letter.
bool is_word_of_mac(std::string_view word) {
  constexpr std::array<unsigned, 10> kNotBehindSmall{0x87, 0x88, 0x8A, 0x8C, 0x8D,
                                                     0x8E, 0x8F, 0x90, 0x9D, 0x9F};
  for (std::size_t i = 1; i < word.size(); ++i)
    if (is_small(byte_at(word, i - 1)) &&
        std::ranges::find(kNotBehindSmall, byte_at(word, i)) != kNotBehindSmall.end())
      return true;
  return false;
}

bool has_neighbours_beyond_ascii(std::string_view word) {
  for (std::size_t i = 1; i < word.size(); ++i)
    if (byte_at(word, i - 1) >= 0x80 && byte_at(word, i) >= 0x80) return true;
  return false;
}

bool is_western_word(std::string_view word) {
  const auto is_ascii = [](char c) { return is_ascii_letter(static_cast<unsigned char>(c)); };
  const auto is_letter = [](char c) { return static_cast<unsigned char>(c) >= 0xC0; };
  return std::ranges::any_of(word, is_ascii) && std::ranges::any_of(word, is_letter);
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const std::size_t length = length_of_character(byte_at(bytes, i));
    if (length == 0) return false;
    for (std::size_t k = 1; k < length && i + k < bytes.size(); ++k)
      if ((byte_at(bytes, i + k) & 0xC0) != 0x80) return false;
    i += length;
  }
  return true;
}

void put_utf8(std::string& out, char32_t c) {
  const auto put = [&](char32_t byte) { out.push_back(static_cast<char>(byte)); };
  if (c < 0x80) {
    put(c);
  } else if (c < 0x800) {
    put(0xC0 | (c >> 6));
    put(0x80 | (c & 0x3F));
  } else if (c < 0x10000) {
    put(0xE0 | (c >> 12));
    put(0x80 | ((c >> 6) & 0x3F));
    put(0x80 | (c & 0x3F));
  } else {
    put(0xF0 | (c >> 18));
    put(0x80 | ((c >> 12) & 0x3F));
    put(0x80 | ((c >> 6) & 0x3F));
    put(0x80 | (c & 0x3F));
  }
}

TextEncoding code_page_of(std::string_view bytes) {
  std::size_t cyrillic = 0, western = 0, mac = 0, doubled = 0;
  const auto is_part = [](unsigned c) { return c >= 0x80 || is_ascii_letter(c); };
  for (std::size_t i = 0; i < bytes.size();) {
    std::size_t end = i;
    while (end < bytes.size() && is_part(byte_at(bytes, end))) ++end;
    const auto word = bytes.substr(i, end - i);
    cyrillic += is_cyrillic_word(word);
    western += is_western_word(word);
    mac += is_word_of_mac(word);
    doubled += has_neighbours_beyond_ascii(word);
    i = std::max(end, i + 1);
  }
  if (cyrillic > western) return TextEncoding::windows_1251;
  return mac > western && doubled == 0 ? TextEncoding::mac_roman : TextEncoding::windows_1252;
}

std::string from_code_page(std::string_view bytes, TextEncoding page) {
  std::string out;
  for (const char byte : bytes) put_utf8(out, character_of(static_cast<unsigned char>(byte), page));
  return out;
}

std::string from_utf32(std::string_view bytes, bool big_endian) {
  std::string out;
  for (std::size_t i = 0; i + 3 < bytes.size(); i += 4) {
    char32_t c = 0;
    for (std::size_t k = 0; k < 4; ++k) c = (c << 8) | byte_at(bytes, i + (big_endian ? k : 3 - k));
    const bool is_none = c > 0x10FFFF || (c >= 0xD800 && c < 0xE000);
    if (c != 0xFEFF) put_utf8(out, is_none ? kNoCharacter : c);
  }
  return out;
}

bool has_words_beyond_ascii(std::string_view utf8) {
  // U+00C0 to U+00FF are two bytes, the first of them 0xC3; U+00D7 and U+00F7 are signs.
  const auto letter_at = [&](std::size_t i) {
    return i + 1 < utf8.size() && byte_at(utf8, i) == 0xC3 && byte_at(utf8, i + 1) != 0x97 &&
           byte_at(utf8, i + 1) != 0xB7;
  };
  for (std::size_t i = 0; i < utf8.size(); ++i) {
    if (!letter_at(i)) continue;
    std::size_t end = i;
    while (letter_at(end)) end += 2;
    const bool is_part = (i > 0 && is_ascii_letter(byte_at(utf8, i - 1))) ||
                         (end < utf8.size() && is_ascii_letter(byte_at(utf8, end)));
    if (end - i >= 4 && !is_part) return true;
    i = end;
  }
  return false;
}

}  // namespace sandhopper
