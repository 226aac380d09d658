#include "tools/report/study_text.hpp"

#include <fmt/format.h>

#include "tools/report/html.hpp"

namespace sandhopper {
namespace {

std::string element(std::string_view tag, std::string_view text) {
  return text.empty() ? "" : fmt::format("<{0}>{1}</{0}>\n", tag, html::escaped(without_marks(text)));
}

std::string cells(std::string_view tag, const std::vector<std::string>& texts) {
  std::string row = "<tr>";
  for (const auto& text : texts)
    row += fmt::format("<{0}>{1}</{0}>", tag, html::escaped(without_marks(text)));
  return row + "</tr>\n";
}

std::string plain(const std::string& paragraph) { return element("p", paragraph); }

std::string plain(const StudyTable& table) {
  if (table.rows.empty()) return element("h3", table.title) + element("p", "No entry.");
  std::string rows = cells("th", table.columns);
  for (const auto& row : table.rows) rows += cells("td", row);
  return element("h3", table.title) + "<div class=\"scroll\"><table>\n" + rows + "</table></div>\n" +
         element("p", table.note);
}

std::string plain(const StudyFigure& figure) {
  return element("p", fmt::format("Figure: {} ({} over {}). It needs JavaScript.", figure.title,
                                  figure.y_label, figure.x_label));
}

std::string plain(const StudyAnswer& answer) {
  std::string text = element("h3", answer.heading);
  for (const auto& [style, line] : answer.lines) text += element("p", line);
  for (const auto& bar : answer.bars) text += element("p", bar.label + ": " + bar.text);
  return text;
}

}  // namespace

std::string without_marks(std::string_view text) {
  return html::replaced(html::replaced(text, "⟦", ""), "⟧", "");
}

std::string study_text(const Study& study) {
  std::string text =
      "<p>Without JavaScript this page shows its text and tables, but no figures. The scripts are part of "
      "the "
      "file; nothing is loaded.</p>\n" +
      element("p", study.verdict);
  for (const auto& warning : study.warnings) text += element("p", warning);
  for (const auto& answer : study.answers) text += plain(answer);
  for (const auto& [label, fact] : study.facts) text += element("p", label + ": " + fact);
  for (const auto& section : study.sections) {
    text += element("h2", section.title);
    for (const auto& item : section.items)
      text += std::visit([](const auto& one) { return plain(one); }, item);
  }
  return text;
}

}  // namespace sandhopper
