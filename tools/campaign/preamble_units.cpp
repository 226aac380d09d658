#include "tools/campaign/preamble_units.hpp"

#include <algorithm>
#include <array>

#include "tools/campaign/column_guess.hpp"

namespace sandhopper {
namespace {

constexpr std::string_view kMarks = " \t:=,;|\"()[]{}";

std::vector<std::string_view> tokens_of(std::string_view text) {
  std::vector<std::string_view> tokens;
  while (!text.empty()) {
    const auto begin = text.find_first_not_of(kMarks);
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const auto end = std::min(text.find_first_of(kMarks), text.size());
    tokens.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return tokens;
}

// True for the word alone and within a key: "unit", "ForceUnit", "Y_Unit_Label".
bool is_word_for_unit(std::string_view token) {
  constexpr std::array<std::string_view, 12> kWords{"unit",     "units",  "einheit", "einheiten",
                                                    "unité",    "unités", "unite",   "unidad",
                                                    "unidades", "unità",  "eenheid", "eenheden"};
  return std::ranges::any_of(words_of_name(token), [&](const std::string& word) {
    return std::ranges::find(kWords, word) != kWords.end();
  });
}

}  // namespace

void PreambleUnits::take(const TextRow& row) {
  const auto names = table_.layout.header_line;
  if (names == 0 || row.line >= names || row.line == table_.layout.units_line) return;
  const auto tokens = tokens_of(row.text);
  const auto word = std::ranges::find_if(tokens, is_word_for_unit);
  if (word == tokens.end()) return;
  std::vector<std::string> subject;
  for (auto token = tokens.begin(); token <= word; ++token)
    for (auto& part : words_of_name(*token)) subject.push_back(std::move(part));
  for (auto token = word + 1; token != tokens.end(); ++token) {
    // In "units in mm" the word "in" is no inch.
    if (*token == "in" && token + 1 != tokens.end()) continue;
    const auto unit = read_unit(*token, false);
    if (unit && !unit->dimension.empty())
      units_.push_back({row.line, std::string(trimmed_cell(row.text)), *unit, subject});
  }
}

const PreambleUnit* unit_above_for(const std::vector<PreambleUnit>& units, std::string_view column,
                                   std::string_view dimension) {
  const auto name = words_of_name(column);
  const PreambleUnit* first = nullptr;
  for (const auto& stated : units) {
    if (!dimension.empty() && stated.unit.dimension != dimension) continue;
    const bool is_named = std::ranges::any_of(name, [&](const std::string& word) {
      return std::ranges::find(stated.subject, word) != stated.subject.end();
    });
    if (is_named) return &stated;
    if (first == nullptr && !dimension.empty()) first = &stated;
  }
  return first;
}

}  // namespace sandhopper
