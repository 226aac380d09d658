#pragma once
#include <cstddef>

#include "tools/diagnose/fit/problem.hpp"

namespace sandhopper::diagnose {

// Deviance that the other effects of a point explain in those rows where effect `e` acts (above a tenth of
// its largest change in that trial). Effect `e` may only correct the form of a larger effect's law; that is
// possible only in rows where the larger one acts. Each row counts at most kFormUnnoticedPerRow.
double shown_by_others(const Problem& problem, const Point& point, std::size_t e);

}  // namespace sandhopper::diagnose
