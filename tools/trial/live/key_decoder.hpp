#pragma once
#include <string>
#include <string_view>

namespace sandhopper {

// Single keys out of what a terminal sends. Escape sequences (arrows, function keys) and pasted text are
// passed over: nobody arms a robot by pasting a word with an `a` in it.
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
