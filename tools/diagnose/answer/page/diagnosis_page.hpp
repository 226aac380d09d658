#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/diagnose/answer/diagnosis.hpp"
#include "tools/report/study.hpp"

namespace sandhopper::diagnose {

// What a page says besides the diagnosis itself.
struct PageFacts {
  std::string campaign;  // its name
  std::string plant;
  std::vector<std::string> findings;  // what was wrong with the files, one line each
};

// The answer as a page: the first screen says where, what, how sure, how much better and what next; below
// stand the recordings with both simulations, errors by channel and phase, effects, unknown forces, what is
// absent, what was tried.
Study diagnosis_study(const Diagnosis& diagnosis, const PageFacts& facts);

// Throws std::runtime_error with path and cause where that fails.
void write_diagnosis_page(const Diagnosis& diagnosis, const PageFacts& facts,
                          const std::filesystem::path& path);

// Parts of it.
std::string in_words(std::string name);       // "fast fall" of "fast_fall"
bool is_changed(const Diagnosis& diagnosis);  // something was found that changes the simulation
std::vector<StudyAnswer> page_answers(const Diagnosis& diagnosis);
std::vector<StudySection> page_sections(const Diagnosis& diagnosis, const PageFacts& facts);
StudySection trial_section(const Diagnosis& diagnosis, const std::string& trial);
StudySection next_trial_section(const Diagnosis& diagnosis);

}  // namespace sandhopper::diagnose
