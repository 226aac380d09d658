#include "tools/trial/live/pane.hpp"

#include <algorithm>

namespace sandhopper {

std::vector<std::string> wrap(std::string_view text, int columns, int indent) {
  std::vector<std::string> lines;
  auto rest = decode_utf8(text);
  const auto width = static_cast<std::size_t>(std::max(columns, indent + 1));
  std::u32string line;
  while (!rest.empty()) {
    if (!lines.empty()) line.assign(static_cast<std::size_t>(indent), U' ');
    const auto room = width - line.size();
    std::size_t count = rest.size();
    if (count > room) {
      count = rest.rfind(U' ', room);
      if (count == std::u32string::npos || count == 0) count = room;
    }
    line += rest.substr(0, count);
    rest.erase(0, count);
    rest.erase(0, std::min(rest.find_first_not_of(U' '), rest.size()));
    lines.emplace_back();
    for (const char32_t c : line) append_utf8(lines.back(), c);
    line.clear();
  }
  return lines;
}

bool Pane::line() {
  if (left() <= 0) {
    used_ = area_.rows + 1;
    return false;
  }
  ++used_;
  return true;
}

void Pane::put(int column, std::string_view text, Style style) {
  if (used_ == 0 || used_ > area_.rows) return;
  canvas_.put_within(row() - 1, area_.column + column, area_.column + area_.columns, text, style);
}

void Pane::put_right(int end, std::string_view text, Style style) {
  if (used_ == 0 || used_ > area_.rows) return;
  canvas_.put_right(row() - 1, area_.column + end, text, style);
}

void Pane::heading(std::string_view text) {
  if (!line()) return;
  put(0, text, Style::heading);
  const int from = static_cast<int>(decode_utf8(text).size()) + 1;
  std::string rule;
  for (int i = from; i < area_.columns; ++i) rule += "─";
  put(from, rule, Style::faint);
}

void Pane::paragraph(std::string_view text, int indent, int most, Style style) {
  for (const auto& one : wrap(text, area_.columns, indent)) {
    if (most-- <= 0 || !line()) return;
    put(0, one, style);
  }
}

}  // namespace sandhopper
