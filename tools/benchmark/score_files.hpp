#pragma once
#include "tools/benchmark/figures.hpp"

namespace sandhopper::benchmark {

struct Column {
  std::string name;  // "hop diagnose", "null only", …
  Score score;
};

// Scores over one set of answers: the tool first, then the baselines that look at nothing, then other tools'
// diagnoses by name and folder. The truths must outlive the scores.
std::vector<Column> score_all(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses,
                              const std::vector<std::pair<std::string, std::filesystem::path>>& others);

// Of the campaigns whose diagnosis named a class that holds the truth: how often a trial more leaves a
// smaller class that still does. Beside the folder of diagnoses are after/, made with the trial recommended,
// and random/; none where there was no follow-up. Where it says that no trial splits the class, whether a
// random one does.
std::vector<Figure> split_figures(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses);

// Seconds the tool took, from the runner's notes beside the diagnoses; empty where there are none.
std::vector<double> seconds_taken(const std::vector<Truth>& truths, const std::filesystem::path& diagnoses);

}  // namespace sandhopper::benchmark
