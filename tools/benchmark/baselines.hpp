#pragma once
#include "tools/benchmark/records.hpp"

// Baselines that do not look at the recordings, or use a simple method.
namespace sandhopper::benchmark {

// Always answers that nothing is missing.
Diagnosis null_only();
// Names one of the plant's effects at random, with probability 1 / number of effects. Always the same effect
// for the same campaign.
Diagnosis random_pick(const Truth& truth, const std::vector<std::string>& ids_of_plant);

// The answer of a simple method ("largest_correlation", "fit_every_parameter"), taken from `baselines` in the
// tool's diagnosis.json, with probability 1. nullopt if the tool does not write it.
std::optional<Diagnosis> plainer(const std::optional<Diagnosis>& diagnosis, const std::string& method);

}  // namespace sandhopper::benchmark
