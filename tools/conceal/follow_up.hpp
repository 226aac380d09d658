#pragma once
#include "tools/conceal/case.hpp"

namespace sandhopper::conceal {

// A set-up somebody asks for, with what it leaves open taken from the campaign's first trial of that kind.
// Throws std::invalid_argument where this apparatus cannot do it.
Setup completed(const Case& c, const Json& asked);

// A set-up as the campaign's own are drawn, but a new one.
Setup random_setup(const Case& c);

}  // namespace sandhopper::conceal
