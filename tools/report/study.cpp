#include "tools/report/study.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/report/assets.hpp"
#include "tools/report/html.hpp"
#include "tools/report/study_text.hpp"

namespace sandhopper {
namespace {

using Json = nlohmann::json;

// Values as floats: seven digits are enough for a picture. JSON has no NaN; the page reads null as "no
// value".
Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values)
    list.push_back(std::isfinite(value) ? Json(static_cast<double>(static_cast<float>(value)))
                                        : Json(nullptr));
  return list;
}

// Thins a series of more than kMostPoints points, which would hide one another and make the page large: every
// n-th point is kept.
StudySeries thinned(const StudySeries& series) {
  constexpr std::size_t kMostPoints = 1500;
  if (series.mark != StudySeries::Mark::points || series.x.size() <= kMostPoints) return series;
  const std::size_t step = (series.x.size() + kMostPoints - 1) / kMostPoints;
  StudySeries out = series;
  out.label = series.label + " (one of " + std::to_string(step) + " points)";
  for (auto* values : {&out.x, &out.y, &out.low, &out.high}) {
    for (std::size_t i = 0; i * step < values->size(); ++i) (*values)[i] = (*values)[i * step];
    values->resize((values->size() + step - 1) / step);
  }
  return out;
}

Json series_json(const StudySeries& full) {
  const StudySeries series = thinned(full);
  constexpr std::array<const char*, 4> kMarks{"points", "line", "line_and_points", "band"};
  return {{"label", series.label},        {"x", numbers(series.x)},
          {"y", numbers(series.y)},       {"low", numbers(series.low)},
          {"high", numbers(series.high)}, {"mark", kMarks[static_cast<std::size_t>(series.mark)]},
          {"color", series.color},        {"dashed", series.dashed},
          {"dotted", series.dotted},      {"hollow", series.hollow},
          {"shade", series.shade},        {"shown", series.shown}};
}

Json item_json(const std::string& paragraph) { return {{"kind", "text"}, {"text", paragraph}}; }

Json item_json(const StudyTable& table) {
  return {{"kind", "table"},
          {"title", table.title},
          {"columns", table.columns},
          {"rows", table.rows},
          {"text_columns", table.text_columns},
          {"note", table.note},
          {"row_marks", table.row_marks},
          {"shades", table.shades},
          {"whole", table.whole}};
}

Json item_json(const StudyFigure& figure) {
  Json series = Json::array();
  for (const auto& one : figure.series) series.push_back(series_json(one));
  return {{"kind", "figure"},          {"title", figure.title},
          {"x_label", figure.x_label}, {"y_label", figure.y_label},
          {"series", series},          {"log_x", figure.log_x},
          {"log_y", figure.log_y},     {"categories", figure.categories},
          {"note", figure.note},       {"wide", figure.wide},
          {"marks", figure.marks}};
}

Json answer_json(const StudyAnswer& answer) {
  constexpr std::array<const char*, 4> kStyles{"lead", "text", "equation", "quiet"};
  Json lines = Json::array(), bars = Json::array();
  for (const auto& [style, text] : answer.lines)
    lines.push_back({{"style", kStyles[static_cast<std::size_t>(style)]}, {"text", text}});
  for (const auto& bar : answer.bars)
    bars.push_back({{"label", bar.label}, {"share", bar.share}, {"text", bar.text}, {"color", bar.color}});
  return {{"heading", answer.heading}, {"lines", lines}, {"bars", bars}, {"columns", answer.columns}};
}

std::string data_json(const Study& study) {
  Json sections = Json::array();
  for (const auto& section : study.sections) {
    Json items = Json::array();
    for (const auto& item : section.items)
      items.push_back(std::visit([](const auto& one) { return item_json(one); }, item));
    sections.push_back({{"title", section.title}, {"items", items}, {"folded", section.folded}});
  }
  Json answers = Json::array();
  for (const auto& answer : study.answers) answers.push_back(answer_json(answer));
  const Json json{{"title", study.title},     {"facts", study.facts},
                  {"verdict", study.verdict}, {"verdict_mark", study.verdict_mark},
                  {"answers", answers},       {"warnings", study.warnings},
                  {"sections", sections}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

void tell_apart(StudySeries& series, std::size_t n) {
  constexpr std::array<const char*, 5> kColors{"blue", "orange", "green", "purple", "sand"};
  const std::size_t round = n / kColors.size() % 3;
  series.color = kColors[n % kColors.size()];
  series.dashed = round == 1;
  series.dotted = round == 2;
  series.hollow = round > 0;
}

std::string study_page(const Study& study) {
  using html::replaced;
  std::string page = replaced(report_assets::kStudyPage, "{{title}}", html::escaped(study.title));
  page = replaced(page, "{{style}}", report_assets::kStyle);
  page = replaced(page, "{{study-style}}", report_assets::kStudyStyle);
  page = replaced(page, "{{script}}", report_assets::kStudyScript);
  page = replaced(page, "{{without-scripts}}", study_text(study));
  return replaced(page, "{{data}}", html::embedded_json(data_json(study)));
}

void write_study_page(const Study& study, const std::filesystem::path& path) {
  html::write(study_page(study), path);
}

}  // namespace sandhopper
