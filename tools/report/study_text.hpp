#pragma once
#include <string>

#include "tools/report/study.hpp"

namespace sandhopper {

// The study as plain HTML for a reader without scripts: verdict, answers, warnings, facts, paragraphs and
// tables. A figure is its title and a sentence that it needs scripts.
std::string study_text(const Study& study);

}  // namespace sandhopper
