#pragma once
#include "tools/benchmark/records.hpp"

// Tools that look at nothing, to be beaten.
namespace sandhopper::benchmark {

// Says every time that nothing is missing.
Diagnosis null_only();
// Names one of the plant's effects at random each time, as sure as its chance; the same for the same
// campaign.
Diagnosis random_pick(const Truth& truth, const std::vector<std::string>& ids_of_plant);

}  // namespace sandhopper::benchmark
