#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// A key of the view and the word it sends. `meaning` is what is on the screen.
struct OperatorKey {
  char key;
  std::string_view word;
  std::string_view meaning;
};

inline constexpr std::array<OperatorKey, 5> kOperatorKeys{{{'a', "arm", "arm"},
                                                           {'r', "release", "release"},
                                                           {'s', "stop", "stop"},
                                                           {'d', "disarm", "disarm"},
                                                           {'q', "quit", "quit"}}};

// Lower or upper case; the space bar is `stop`, Ctrl-C is `quit`. No key: nullptr.
const OperatorKey* operator_key(char32_t typed);

// Why this word would do nothing now, and what would; nothing: it does what it says.
std::optional<std::string> why_not(std::string_view word, const TrialModel& model);

}  // namespace sandhopper
