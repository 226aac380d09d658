#pragma once
#include <string>
#include <string_view>

#include "tools/report/study.hpp"

namespace sandhopper {

// The study as plain HTML for a reader without scripts: verdict, answers, warnings, facts, paragraphs and
// tables. A figure is its title and a sentence that it needs scripts.
std::string study_text(const Study& study);

// Texts of a study may hold equations between ⟦ and ⟧, such as ⟦F_c = p' - psi⟧, which its page sets. This is
// the text without the marks, for terminals and files.
std::string without_marks(std::string_view text);

}  // namespace sandhopper
