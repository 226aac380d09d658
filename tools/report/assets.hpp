#pragma once
#include <string_view>

// Files of tools/report/page/ and of the plotting library, embedded when building (assets.cmake).
namespace sandhopper::report_assets {

extern const std::string_view kPage;         // page.html
extern const std::string_view kStyle;        // page.css
extern const std::string_view kScript;       // the page's own scripts, in order
extern const std::string_view kStudyPage;    // study.html
extern const std::string_view kStudyStyle;   // study.css, after kStyle
extern const std::string_view kStudyScript;  // its scripts, in order
extern const std::string_view kExplainPage;
extern const std::string_view kExplainStyle;
extern const std::string_view kExplainScript;
extern const std::string_view kPlotStyle;  // dygraphs
extern const std::string_view kPlotScript;

}  // namespace sandhopper::report_assets
