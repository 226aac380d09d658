#include "config/consistency.hpp"

namespace sandhopper {

void refuse(const std::vector<Contradiction>& found, const ConfigDocument& document) {
  if (found.empty()) return;
  std::vector<ConfigProblem> problems;
  problems.reserve(found.size());
  const bool has_lines = !document.root.children.empty();
  for (const auto& c : found)
    problems.push_back({.file = document.name,
                        .position = has_lines ? nearest_node(document.root, c.key).key_position
                                              : ConfigPosition{.line = 0, .column = 0},
                        .key = c.key,
                        .text = "key '" + c.key + "' does not fit: " + c.text});
  throw ConfigError(problems);
}

}  // namespace sandhopper
