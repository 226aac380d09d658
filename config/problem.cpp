#include "config/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace sandhopper {
namespace {

std::vector<ConfigProblem> in_file_order(std::vector<ConfigProblem> problems) {
  std::stable_sort(problems.begin(), problems.end(), [](const ConfigProblem& a, const ConfigProblem& b) {
    return std::tie(a.file, a.position.line, a.position.column) <
           std::tie(b.file, b.position.line, b.position.column);
  });
  return problems;
}

std::string one_line_each(const std::vector<ConfigProblem>& problems) {
  std::string text;
  for (const auto& problem : problems) text += (text.empty() ? "" : "\n") + to_string(problem);
  return text;
}

}  // namespace

std::string to_string(const ConfigProblem& p) {
  if (p.position.line == 0) return fmt::format("{}: {}", p.file, p.text);
  return fmt::format("{}:{}:{}: {}", p.file, p.position.line, p.position.column, p.text);
}

ConfigError::ConfigError(const std::vector<ConfigProblem>& problems)
    : std::runtime_error(one_line_each(in_file_order(problems))), problems_(in_file_order(problems)) {}

}  // namespace sandhopper
