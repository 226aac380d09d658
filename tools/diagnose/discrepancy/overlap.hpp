#pragma once
#include <cstddef>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// What the other effects of a point change, in noise's power, where effect `e` of it shows (more than a tenth
// of its most in that trial): a large effect's law in another form may leave a part of that, and passes for
// an effect there, but not where it changes nothing. At most so much a row as passes unnoticed for a form.
double shown_by_others(const Problem& problem, const Point& point, std::size_t e);

}  // namespace sandhopper::diagnose
