#pragma once
#include <string_view>

// The files of tools/report/page/ and the plotting library dygraphs. The build embeds them into the program
// (assets.cmake).
namespace sandhopper::report_assets {

extern const std::string_view kPage;         // page.html
extern const std::string_view kStyle;        // page.css
extern const std::string_view kScript;       // all scripts of page.html, concatenated
extern const std::string_view kStudyPage;    // study.html
extern const std::string_view kStudyStyle;   // study.css, to be placed after kStyle
extern const std::string_view kStudyScript;  // all scripts of study.html, concatenated
extern const std::string_view kExplainPage;
extern const std::string_view kExplainStyle;
extern const std::string_view kExplainScript;
extern const std::string_view kPlotStyle;  // dygraphs
extern const std::string_view kPlotScript;

}  // namespace sandhopper::report_assets
