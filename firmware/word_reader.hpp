#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "firmware/request_box.hpp"

namespace sandhopper {

// Parses the operator's bytes into words, one per line. Spaces, tabs, carriage returns and other control
// characters around a word are dropped, and case does not matter; an empty line is no word. A line longer
// than kLongestLine is one unknown word, returned as soon as the limit is exceeded.
class WordReader {
 public:
  static constexpr std::size_t kLongestLine = 1024;

  struct Line {
    Word word;
    std::string text;  // the trimmed text, at most kShown bytes, for messages
  };
  static constexpr std::size_t kShown = 64;

  // Appends the words of the lines that these bytes complete.
  void read(std::string_view bytes, std::vector<Line>& lines);
  // At the end of input: a last line without a line end counts, too.
  void end(std::vector<Line>& lines);

 private:
  void take(std::string_view line, std::vector<Line>& lines);

  std::string pending_;
  bool skipping_ = false;  // skip the rest of a line that was too long
};

// arm, release, stop, disarm or quit; anything else is Word::unknown.
Word word_named(std::string_view trimmed) noexcept;

}  // namespace sandhopper
