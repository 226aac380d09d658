#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// Report over many trials: one HTML page with sections of text, tables and figures. An analysis fills a
// Study; the page draws it.
namespace sandhopper {

// One set of points. `low` and `high`, if given (same size as y), are drawn as interval bars.
struct StudySeries {
  enum class Mark {
    points,
    line,
    line_and_points,
    band
  };  // band: the area between low and high, with y as a line

  std::string label{};
  std::vector<double> x{};
  std::vector<double> y{};  // NaN breaks a line
  std::vector<double> low{};
  std::vector<double> high{};
  Mark mark = Mark::points;
  std::string color = "blue";  // blue, orange, green, purple, sand, grey, text
  double shade = 0.0;          // 0 to 1: mixes the colour with the page's background
  bool dashed = false;
  bool dotted = false;
  bool hollow = false;  // draws points as rings
  bool shown = true;    // false: hidden until the reader presses its name in the legend
};

// Gives the n-th series a distinguishable style from five colours: n < 5 solid; n < 10 dashed, with rings; n
// < 15 dotted, with rings. Styles repeat from n = 15 on.
void tell_apart(StudySeries& series, std::size_t n);

// A figure: series over two axes.
struct StudyFigure {
  std::string title{};
  std::string x_label{};  // with unit: "depth, mm"
  std::string y_label{};
  std::vector<StudySeries> series{};
  bool log_x = false;
  bool log_y = false;
  std::vector<std::string> categories{};                // names at x = 0, 1, 2, … instead of numbers
  std::vector<std::pair<double, std::string>> marks{};  // dotted vertical lines at x, each with a label
  std::string note{};                                   // one or two sentences below the figure
  bool wide = false;                                    // true: takes the full width of the page
};

// A table; its cells are text.
struct StudyTable {
  std::string title{};
  std::vector<std::string> columns{};  // with unit: "stiffness, N/m"
  std::vector<std::vector<std::string>> rows{};
  std::size_t text_columns = 1;  // number of leading text columns, left-aligned; the rest are numbers
  std::string note{};
  std::vector<std::string> row_marks{};  // "good", "partly" or "bad" for each row: colour of its edge
  // Background of a cell's left and right half, 0 to 1, per row and column; empty: none.
  std::vector<std::vector<std::pair<double, double>>> shades{};
  bool whole = false;  // true: full height, without a scroll bar of its own
};

// A section; `folded`: closed until the reader opens it.
struct StudySection {
  std::string title{};
  std::vector<std::variant<std::string, StudyTable, StudyFigure>>
      items{};  // paragraphs, tables and figures in this order
  bool folded = false;
};

// A box on the first screen: a question as heading and its answer.
struct StudyAnswer {
  enum class Style { lead, text, equation, quiet };
  struct Bar {
    std::string label{};
    double share = 0.0;  // length of the bar, share of the box's width
    std::string text{};
    std::string color = "blue";
  };
  std::string heading{};
  std::vector<std::pair<Style, std::string>> lines{};
  std::vector<Bar> bars{};  // drawn after the first line
  int columns = 2;          // width in columns; the page has six
};

// A page: title, facts and sections, with an optional verdict, answers and warnings.
struct Study {
  std::string title;
  std::string verdict{};       // one sentence above the answers
  std::string verdict_mark{};  // good, partly or bad
  std::vector<StudyAnswer> answers{};
  std::vector<std::pair<std::string, std::string>> facts{};  // label, text
  std::vector<std::string> warnings{};                       // important for the reader, shown first
  std::vector<StudySection> sections{};
};

// The complete HTML text of the page.
std::string study_page(const Study& study);
// Throws std::runtime_error with path and cause if the file cannot be written.
void write_study_page(const Study& study, const std::filesystem::path& path);

}  // namespace sandhopper
