#pragma once
#include <string>
#include <string_view>

#include "tools/campaign/finding.hpp"

// Figures as words.
namespace sandhopper {

std::string figure_number(double value);  // four digits that matter, "–" for none
std::string interval_text(double low, double high);
std::string figure_title(
    std::string_view name);  // "stiffness observer WLS" of "stiffness_observer_wls_N_per_m"
std::string figure_unit(std::string_view name);  // "N/m"
// Depths, heights and diameters stand in mm in every figure and table: 1000 for a name of one in metres,
// else 1.
double page_scale(std::string_view name);
std::string trial_label(std::string_view trial);  // its file's name, without folders and ending
std::string_view cost_text(FindingSeverity severity);

}  // namespace sandhopper
