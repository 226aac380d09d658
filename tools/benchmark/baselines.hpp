#pragma once
#include "tools/benchmark/records.hpp"

// Tools that look at nothing, to be beaten.
namespace sandhopper::benchmark {

// Says every time that nothing is missing.
Diagnosis null_only();
// Names one of the plant's effects at random each time, as sure as its chance; the same for the same
// campaign.
Diagnosis random_pick(const Truth& truth, const std::vector<std::string>& ids_of_plant);

// Says what a plainer method would have named ("largest_correlation", "fit_every_parameter": of `baselines`
// in the tool's diagnosis.json), without doubt, as such a method does. nullopt: the tool tells no such thing.
std::optional<Diagnosis> plainer(const std::optional<Diagnosis>& diagnosis, const std::string& method);

}  // namespace sandhopper::benchmark
