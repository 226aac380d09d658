#include "tools/trial/live/ansi_frame.hpp"

#include <fmt/format.h>

#include <optional>

namespace sandhopper {
namespace {

std::string_view rendition(Style style, bool colour) {
  switch (style) {
    case Style::plain:
      return "\x1b[0m";
    case Style::bold:
    case Style::heading:
      return "\x1b[0;1m";
    case Style::faint:
      return colour ? "\x1b[0;2m" : "\x1b[0m";
    case Style::bar:
      return "\x1b[0;7m";
    case Style::good:
      return colour ? "\x1b[0;1;32m" : "\x1b[0;1m";
    case Style::caution:
      return colour ? "\x1b[0;1;33m" : "\x1b[0;1m";
    case Style::alarm:
      return colour ? "\x1b[0;1;37;41m" : "\x1b[0;1;7m";
    case Style::key:
      return "\x1b[0;1;7m";
  }
  return "\x1b[0m";
}

// Most similar character that every terminal has.
char32_t plain_character(char32_t c) {
  if (c < 0x7f) return c;
  if (c >= U'▁' && c <= U'█') return U".:-=+*%#"[static_cast<std::size_t>(c - U'▁')];
  switch (c) {
    case U'─':
    case U'–':
    case U'…':
      return c == U'…' ? U'~' : U'-';
    case U'·':
      return U'.';
    case U'°':
      return U' ';
    case U'│':
      return U'|';
    case U'≤':
      return U'<';
    case U'µ':
      return U'u';
    default:
      return U'?';
  }
}

}  // namespace

std::string ansi_frame(const Canvas& before, const Canvas& after, const TerminalTraits& traits) {
  std::string out;
  const auto [rows, columns] = after.size();
  const bool anew = before.size() != after.size();
  if (anew) out += "\x1b[0m\x1b[2J";
  std::optional<Style> style;
  for (int row = 0; row < rows; ++row) {
    int cursor = -1;  // column of the terminal's cursor in this row
    for (int column = 0; column < columns; ++column) {
      const auto& cell = after.at(row, column);
      if (anew ? cell == Canvas::Cell{} : cell == before.at(row, column)) continue;
      if (cursor != column) out += fmt::format("\x1b[{};{}H", row + 1, column + 1);
      if (style != cell.style) out += rendition(cell.style, traits.colour);
      style = cell.style;
      append_utf8(out, traits.utf8 ? cell.character : plain_character(cell.character));
      cursor = column + 1;
    }
  }
  if (style) out += "\x1b[0m";
  return out;
}

}  // namespace sandhopper
