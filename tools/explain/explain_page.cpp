#include "tools/explain/explain_page.hpp"

#include <fmt/format.h>

#include "tools/explain/explanation_json.hpp"
#include "tools/report/assets.hpp"
#include "tools/report/html.hpp"
#include "tools/report/report_json.hpp"

namespace sandhopper {
namespace {

std::string verdict(const Explanation& e) {
  if (e.faults.empty())
    return "hopperd was killed, crashed or stood still: these are the last cycles it ran.";
  const auto& reading = e.faults.front().reading;
  return fmt::format("{}{}: {}; allowed: {}", reading.device.empty() ? "" : reading.device + ", ",
                     reading.quantity, reading.value_text, reading.limit_text);
}

// Sentence about the fault's end, as far as the file shows it.
std::string ending(const Explanation& e) {
  if (e.faults.empty()) return "The guard process switched the drives off, where there was one.";
  const auto& entry = entry_of(e.faults.back().fault);
  return fmt::format("Reaction of {}: {}. The fault lasts {}.", entry.name, name_of(entry.reaction),
                     in_plain_words(name_of(entry.latch)));
}

}  // namespace

std::string explanation_page(const Explanation& e) {
  nlohmann::json data = report_json(e.data, 1);
  data["explained"] = explanation_json(e);
  data["explained"]["verdict"] = verdict(e);
  data["explained"]["ending"] = ending(e);

  using html::replaced;
  std::string page = replaced(report_assets::kExplainPage, "{{title}}", html::escaped(e.title));
  page = replaced(page, "{{style}}", report_assets::kStyle);
  page = replaced(page, "{{explain-style}}", report_assets::kExplainStyle);
  page = replaced(page, "{{plot-style}}", report_assets::kPlotStyle);
  page = replaced(page, "{{plot-script}}", report_assets::kPlotScript);
  page = replaced(page, "{{script}}", report_assets::kExplainScript);
  return replaced(page, "{{data}}", html::embedded_json(page_text(data)));
}

void write_explanation_page(const Explanation& e, const std::filesystem::path& path) {
  html::write(explanation_page(e), path);
}

}  // namespace sandhopper
