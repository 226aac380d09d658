#include "tools/trial/live/canvas.hpp"

#include <algorithm>
#include <cwchar>

namespace sandhopper {
namespace {

char32_t one_column(char32_t c) {
  if (c < 0x20 || (c >= 0x7f && c < 0xa0)) return U'?';
  if (c < 0x300) return c;
  const bool drawing = (c >= 0x2000 && c < 0x2c00);  // punctuation, arrows, blocks, Braille
  return drawing || (c < 0x1100 && ::wcwidth(static_cast<wchar_t>(c)) == 1) ? c : U'?';
}

}  // namespace

// Each malformed byte becomes '?'.
std::u32string decode_utf8(std::string_view text) {
  std::u32string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const int length = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc2 ? 2 : 0;
    char32_t c = length == 1 ? first : first & (0x7fU >> length);
    bool sound = length > 0 && i + static_cast<std::size_t>(length) <= text.size();
    for (std::size_t k = 1; sound && k < static_cast<std::size_t>(length); ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      sound = (next & 0xc0U) == 0x80U;
      c = (c << 6U) | (next & 0x3fU);
    }
    out.push_back(sound ? c : U'?');
    i += sound ? static_cast<std::size_t>(length) : 1;
  }
  return out;
}

void append_utf8(std::string& out, char32_t c) {
  const auto tail = [&](int shift) { out.push_back(static_cast<char>(0x80U | ((c >> shift) & 0x3fU))); };
  if (c < 0x80) {
    out.push_back(static_cast<char>(c));
  } else if (c < 0x800) {
    out.push_back(static_cast<char>(0xc0U | (c >> 6U)));
    tail(0);
  } else if (c < 0x10000) {
    out.push_back(static_cast<char>(0xe0U | (c >> 12U)));
    tail(6);
    tail(0);
  } else {
    out.push_back(static_cast<char>(0xf0U | (c >> 18U)));
    tail(12);
    tail(6);
    tail(0);
  }
}

Canvas::Canvas(ScreenSize size)
    : size_{std::max(1, size.rows), std::max(1, size.columns)},
      cells_(static_cast<std::size_t>(size_.rows) * static_cast<std::size_t>(size_.columns)) {}

int Canvas::put(int row, int column, std::string_view text, Style style) {
  for (const char32_t c : decode_utf8(text)) {
    if (row >= 0 && row < size_.rows && column >= 0 && column < size_.columns)
      cells_[index(row, column)] = {one_column(c), style};
    ++column;
  }
  return column;
}

int Canvas::put_within(int row, int column, int end, std::string_view text, Style style) {
  auto characters = decode_utf8(text);
  const int room = end - column;
  if (room <= 0) return column;
  if (static_cast<int>(characters.size()) > room) {
    characters.resize(static_cast<std::size_t>(room));
    characters.back() = U'…';
  }
  std::string fitting;
  for (const char32_t c : characters) append_utf8(fitting, c);
  return put(row, column, fitting, style);
}

void Canvas::put_right(int row, int end, std::string_view text, Style style) {
  put(row, end - static_cast<int>(decode_utf8(text).size()), text, style);
}

void Canvas::fill(int row, Style style) {
  for (int column = 0; column < size_.columns; ++column) cells_[index(row, column)].style = style;
}

std::string Canvas::row_text(int row) const {
  std::string out;
  for (int column = 0; column < size_.columns; ++column) append_utf8(out, at(row, column).character);
  out.resize(out.find_last_not_of(' ') + 1);
  return out;
}

}  // namespace sandhopper
