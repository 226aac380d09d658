#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// A report over many trials: sections of text, tables and figures, as one HTML page that holds all it shows.
// Whoever analyses fills a Study; the page draws any of it.
namespace sandhopper {

// One set of points. Intervals are drawn as bars where `low` and `high` are given (same size as y).
struct StudySeries {
  enum class Mark {
    points,
    line,
    line_and_points,
    band
  };  // band: the area between low and high, with y as line

  std::string label{};
  std::vector<double> x{};
  std::vector<double> y{};  // NaN breaks a line
  std::vector<double> low{};
  std::vector<double> high{};
  Mark mark = Mark::points;
  std::string color = "blue";  // blue, orange, green, purple, sand, grey, text
  double shade = 0.0;          // 0 to 1: how far the colour is drawn towards the paper's
  bool dashed = false;
  bool dotted = false;
  bool hollow = false;  // points as rings
  bool shown = true;    // false: hidden until its name in the legend is pressed
};

// Gives the n-th of several trials a look of its own: five colours; then dashed or rings; then dotted. From
// the sixteenth on looks repeat.
void tell_apart(StudySeries& series, std::size_t n);

struct StudyFigure {
  std::string title{};
  std::string x_label{};  // with unit: "depth, mm"
  std::string y_label{};
  std::vector<StudySeries> series{};
  bool log_x = false;
  bool log_y = false;
  std::vector<std::string> categories{};                // names of x = 0, 1, 2, … in place of numbers
  std::vector<std::pair<double, std::string>> marks{};  // dotted lines at an x, each with a word
  std::string note{};                                   // one or two sentences below it
  bool wide = false;                                    // takes the page's whole width
};

struct StudyTable {
  std::string title{};
  std::vector<std::string> columns{};  // "stiffness, N/m"
  std::vector<std::vector<std::string>> rows{};
  std::size_t text_columns = 1;  // the first so many are text, left-aligned; the rest numbers
  std::string note{};
  std::vector<std::string> row_marks{};  // "good", "partly" or "bad" for each row: its coloured edge
  // Shade of a cell's left and right half, 0 to 1, per row and column; empty: none.
  std::vector<std::vector<std::pair<double, double>>> shades{};
  bool whole = false;  // as long as it is, without a scroll bar of its own
};

struct StudySection {
  std::string title{};
  std::vector<std::variant<std::string, StudyTable, StudyFigure>>
      items{};  // paragraphs, tables, figures in order
  bool folded = false;
};

// A box of the first screen: a question as heading and its answer.
struct StudyAnswer {
  enum class Style { lead, text, equation, quiet };
  struct Bar {
    std::string label{};
    double share = 0.0;  // of the box's width
    std::string text{};
    std::string color = "blue";
  };
  std::string heading{};
  std::vector<std::pair<Style, std::string>> lines{};
  std::vector<Bar> bars{};  // after the first line
  int columns = 2;          // of the six that the page has
};

struct Study {
  std::string title;
  std::string verdict{};       // one sentence above the answers
  std::string verdict_mark{};  // good, partly or bad
  std::vector<StudyAnswer> answers{};
  std::vector<std::pair<std::string, std::string>> facts{};  // label, text
  std::vector<std::string> warnings{};                       // what the reader must know first
  std::vector<StudySection> sections{};
};

std::string study_page(const Study& study);
// Throws std::runtime_error with path and cause where that fails.
void write_study_page(const Study& study, const std::filesystem::path& path);

}  // namespace sandhopper
