#pragma once
#include "tools/benchmark/figures.hpp"

namespace sandhopper::benchmark {

// Results of one tool: a column of the report.
struct Column {
  std::string name;  // "hop diagnose", "null only", …
  Score score;
};

// Scores for one set of answers: the tool, then the baselines, then other tools' diagnoses (name, folder).
// `truths` must outlive the scores.
std::vector<Column> score_all(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses,
                              const std::vector<std::pair<std::string, std::filesystem::path>>& others);

// For campaigns whose diagnosis named a class with the true effect: how often one further trial gives a
// smaller class that still contains it, for the recommended trial (after/) and a random one (random/). Third
// row: how often a random trial does so although the tool said that none would. Empty if there was no
// follow-up.
std::vector<Figure> split_figures(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses);

// Run times of the tool, s, from the runner's notes next to the diagnoses; empty if there are none.
std::vector<double> seconds_taken(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses);

}  // namespace sandhopper::benchmark
