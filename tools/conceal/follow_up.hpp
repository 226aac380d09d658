#pragma once
#include "tools/conceal/case.hpp"

namespace sandhopper::conceal {

// A requested set-up; missing keys are taken from the campaign's first trial of that kind. Throws
// std::invalid_argument if this apparatus cannot do it.
Setup completed(const Case& c, const Json& asked);

// A new set-up, drawn like those of the campaign.
Setup random_setup(const Case& c);

}  // namespace sandhopper::conceal
