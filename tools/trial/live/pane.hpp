#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/trial/live/canvas.hpp"

namespace sandhopper {

// A rectangle of the canvas that is filled line by line from its top. Lines that do not fit are left out.
class Pane {
 public:
  struct Area {
    int row, column, rows, columns;
  };
  Pane(Canvas& canvas, Area area) : canvas_(canvas), area_(area) {}

  int left() const { return area_.rows - used_; }  // lines
  int columns() const { return area_.columns; }
  int row() const { return area_.row + used_; }

  // Begins a line; put() writes on it. False if there is no room.
  bool line();
  void put(int column, std::string_view text, Style style = Style::plain);
  void put_right(int end, std::string_view text, Style style = Style::plain);
  void blank() { line(); }
  // "Title ─────────"
  void heading(std::string_view text);
  // Uses as many lines as needed, at most `most`; all lines after the first are indented.
  void paragraph(std::string_view text, int indent, int most, Style style = Style::plain);
  Pane below() const { return {canvas_, {row(), area_.column, left(), area_.columns}}; }
  Canvas& canvas() { return canvas_; }
  const Area& area() const { return area_; }

 private:
  Canvas& canvas_;
  Area area_;
  int used_ = 0;
};

// Breaks a text at blanks into lines of at most `columns` characters (a longer word is also broken). All
// lines except the first are indented.
std::vector<std::string> wrap(std::string_view text, int columns, int indent);

}  // namespace sandhopper
