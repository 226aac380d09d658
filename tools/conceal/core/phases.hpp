#pragma once
#include <string>
#include <vector>

#include "tools/conceal/core/keys.hpp"
#include "tools/conceal/core/random.hpp"
#include "tools/conceal/core/table.hpp"

namespace sandhopper::conceal {

// "early", "middle" or "late" for each row: thirds of the time from the first to the last row.
std::vector<std::string> thirds_of_time(const Table& recorded);

// The same with the arguments of PlantSpec::phases.
template <class World>
std::vector<std::string> thirds_of_time(const World&, const Setup&, const TrialRandom&,
                                        const Table& recorded) {
  return thirds_of_time(recorded);
}

}  // namespace sandhopper::conceal
