#include "tools/report/trial_page.hpp"

#include "tools/report/assets.hpp"
#include "tools/report/envelope.hpp"
#include "tools/report/html.hpp"
#include "tools/report/report_json.hpp"

namespace sandhopper {
std::string trial_page(const ReportData& data) {
  std::size_t envelope_run = 1;
  const ReportData shown = envelope(data, {}, envelope_run);
  using html::replaced;
  const std::string json = html::embedded_json(page_text(report_json(shown, envelope_run)));

  std::string page = replaced(report_assets::kPage, "{{title}}", html::escaped(data.title));
  page = replaced(page, "{{style}}", report_assets::kStyle);
  page = replaced(page, "{{plot-style}}", report_assets::kPlotStyle);
  page = replaced(page, "{{plot-script}}", report_assets::kPlotScript);
  page = replaced(page, "{{script}}", report_assets::kScript);
  return replaced(page, "{{data}}", json);
}

void write_trial_report(const ReportData& data, const std::filesystem::path& path) {
  html::write(trial_page(data), path);
}

}  // namespace sandhopper
