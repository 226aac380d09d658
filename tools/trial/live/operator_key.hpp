#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "tools/trial/live/trial_model.hpp"

namespace sandhopper {

// A key of the view and the word it sends. `meaning` is shown on the screen.
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

// Lower or upper case. The space bar is `stop`, Ctrl-C is `quit`. nullptr if the key has no meaning.
const OperatorKey* operator_key(char32_t typed);

// Reason why this word would have no effect now, with the word that would. Empty if it has an effect.
std::optional<std::string> why_not(std::string_view word, const TrialModel& model);

}  // namespace sandhopper
