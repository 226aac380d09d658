#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/report/study.hpp"

namespace sandhopper::diagnose {

// Facts on the page that are not in the diagnosis.
struct PageFacts {
  std::string campaign;  // name of the campaign
  std::string plant;
  std::vector<std::string> findings;  // problems with the files, one line each
};

// The answer as a page. The first screen gives place, effects, probability, improvement and the next trial.
// Below: recordings with both simulations, errors by channel and phase, effects, unknown forces, absent
// effects, log of the search.
Study diagnosis_study(const Diagnosis& diagnosis, const PageFacts& facts);

// Writes the page to `path`. Throws std::runtime_error with path and cause on failure.
void write_diagnosis_page(const Diagnosis& diagnosis, const PageFacts& facts,
                          const std::filesystem::path& path);

// Parts of the page.
bool is_changed(const Diagnosis& diagnosis);  // True if a finding changes the simulation.
std::vector<StudyAnswer> page_answers(const Diagnosis& diagnosis);
std::vector<StudySection> page_sections(const Diagnosis& diagnosis, const PageFacts& facts);
// Recorded and simulated traces of one trial.
StudySection trial_section(const Diagnosis& diagnosis, const std::string& trial);
// Numbers that are fitted in each trial; those beyond their believed spread are marked.
StudySection trial_to_trial_section(const Diagnosis& diagnosis);
// Predictions of the recommended trial by two explanations.
StudySection next_trial_section(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
