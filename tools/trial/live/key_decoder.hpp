#pragma once
#include <string>
#include <string_view>

namespace sandhopper {

// Extracts single keys from a terminal's input. Escape sequences (arrows, function keys) and pasted text are
// ignored, so that pasting a word with an `a` in it does not arm the robot.
class KeyDecoder {
 public:
  std::u32string take(std::string_view bytes);

 private:
  enum class In { text, escape, sequence };
  In in_ = In::text;
  std::string sequence_;
  bool pasting_ = false;
};

}  // namespace sandhopper
