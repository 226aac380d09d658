#pragma once
#include <string>
#include <vector>

#include "tools/terrain/profile_trials.hpp"

// A pooled profile in words and numbers (terminal, table, JSON). profile_page.cpp draws it.
namespace sandhopper {

std::string short_number(double value);            // three significant digits, whole numbers from 1000 on
std::string group_title(const CurveGroup& group);  // "plates of 60 mm pressed slowly, 3 trials"
// Round depths over the visited range, at most eight, for the text.
std::vector<double> listed_depths_m(const CurveGroup& group);
std::string pooled_text(const PooledValue& value, double scale = 1.0);  // "31.2 [28.1, 34.3]"
std::string new_trial_text(const PooledValue& value, double scale = 1.0);
std::string numbers_text(const CurveGroup& group);  // slope, line, secant and exponent in one sentence
std::string shapes_text(const CurveGroup& group);
std::string left_out_text(const CurveGroup& group);  // empty for too few trials
std::string prediction_text(const ProfilePrediction& prediction);
std::string bound_text(const CurveGroup& group);  // for ground on which no depth could be measured
std::string profile_answer(const CurveGroup& group);
std::vector<std::string> profile_lines(const ProfileConclusion& conclusion);
std::string profile_csv(const ProfileConclusion& conclusion);
nlohmann::ordered_json profile_json(const ProfileConclusion& conclusion);

}  // namespace sandhopper
