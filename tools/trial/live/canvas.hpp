#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sandhopper {

// Appearance of a piece of the screen. Every information that a colour gives is also in the text.
enum class Style : std::uint8_t { plain, bold, faint, bar, heading, good, caution, alarm, key };

struct ScreenSize {
  int rows = 24;
  int columns = 80;
  friend bool operator==(const ScreenSize&, const ScreenSize&) = default;
};

// A screen of characters, each one column wide (a wider or unprintable one becomes '?'). Text outside is cut
// off.
class Canvas {
 public:
  struct Cell {
    char32_t character = U' ';
    Style style = Style::plain;
    friend bool operator==(const Cell&, const Cell&) = default;
  };

  explicit Canvas(ScreenSize size);
  ScreenSize size() const { return size_; }
  const Cell& at(int row, int column) const { return cells_[index(row, column)]; }

  // Text is UTF-8. Returns the column after it.
  int put(int row, int column, std::string_view text, Style style = Style::plain);
  // Ends in "…" if it would extend beyond `end`.
  int put_within(int row, int column, int end, std::string_view text, Style style = Style::plain);
  void put_right(int row, int end, std::string_view text, Style style = Style::plain);
  void fill(int row, Style style);

  std::string row_text(int row) const;  // UTF-8, without trailing blanks

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.columns) +
           static_cast<std::size_t>(column);
  }
  ScreenSize size_;
  std::vector<Cell> cells_;
};

std::u32string decode_utf8(std::string_view text);
void append_utf8(std::string& out, char32_t character);

}  // namespace sandhopper
