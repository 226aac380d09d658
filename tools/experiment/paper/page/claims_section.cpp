#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/experiment/paper/report.hpp"

namespace sandhopper::paper {
namespace {

const char* mark_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::comes_out:
      return "good";
    case Verdict::only_if:
      return "partly";
    case Verdict::does_not:
      break;
  }
  return "bad";
}

// Text such as "time: 40.1 ms (35.2 to 50.1)".
std::string figure_text(const ClaimFigure& figure) {
  const auto number = [&figure](double value) {
    const bool tiny = value != 0.0 && std::abs(value) < 1e-6;
    return tiny ? fmt::format("{:.1e}", value) : fmt::format("{:.{}f}", value, figure.digits);
  };
  std::string text = figure.name + ": " + number(figure.value);
  if (!figure.unit.empty()) text += " " + figure.unit;
  if (!std::isnan(figure.lowest))
    text += " (" + number(figure.lowest) + " to " + number(figure.highest) + ")";
  return text;
}

// Replaces blanks by no-break spaces, so that the text stays on one line.
std::string unbroken(std::string_view text) {
  std::string result;
  for (const char c : text) result += c == ' ' ? "\u00a0" : std::string(1, c);
  return result;
}

}  // namespace

StudySection claims_section(const std::vector<Claim>& claims) {
  StudySection section{.title = "Claims"};
  StudyTable table{.title = "",
                   .columns = {"no.", "claim", "passes when", "found", "verdict", "condition or reason"},
                   .text_columns = 6,
                   .note =
                       "One row for each claim of the paper. Passes when: the criterion, which was set "
                       "before the run. Found: figures of this run; with a range in brackets, the mean "
                       "and the smallest and largest trial. Edge: green, it holds; yellow, only on the "
                       "condition named; red, it does not.",
                   .whole = true};
  for (const auto& claim : claims) {
    std::string found;
    for (const auto& figure : claim.figures) found += (found.empty() ? "" : "\n") + figure_text(figure);
    table.rows.push_back({std::to_string(claim.number), claim.statement, claim.pass_line, found,
                          unbroken(words(claim.verdict)), claim.why});
    table.row_marks.emplace_back(mark_of(claim.verdict));
  }
  section.items = {
      std::string(
          "Every figure is computed in this run. Trials are those of the hop set with a liftoff, unless "
          "said otherwise. ⟦k_GT⟧: the bed's stiffness by slow intrusion."),
      std::move(table)};
  return section;
}

}  // namespace sandhopper::paper
