#pragma once
#include <string>
#include <string_view>

#include "tools/campaign/finding.hpp"

// Texts for names and values.
namespace sandhopper {

// "1530 [1200, 1860]", as in the strength profile; the value alone without an interval.
std::string with_interval(double value, double low, double high);

// Three significant digits without an exponent below a million: "1230", "0.0412", "–" for NaN.
std::string rounded_text(double value);
std::string figure_number(double value);  // four significant digits, "–" for NaN
// Both ends to two digits of half the interval, and the value inside it likewise: "2200", "1100 to 3200".
std::string interval_text(double low, double high);
std::string value_text(double value, double low, double high);
std::string figure_title(
    std::string_view name);  // "stiffness observer WLS" for "stiffness_observer_wls_N_per_m"
std::string figure_unit(std::string_view name);  // unit in the name, such as "N/m"
// Scale for figures and tables: 1000 for a name in metres, because depths, heights and diameters are shown in
// mm; otherwise 1.
double page_scale(std::string_view name);
std::string trial_label(std::string_view trial);  // file name without folders and ending
std::string_view cost_text(FindingSeverity severity);

}  // namespace sandhopper
