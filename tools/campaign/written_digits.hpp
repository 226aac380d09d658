#pragma once
#include <map>
#include <string>
#include <string_view>

#include "tools/campaign/campaign.hpp"

namespace sandhopper {

// Half a unit of the last digit of a number: as its text says (0.110: 0.0005; 4e3: 500), or, where only its
// value is known, of the shortest text that gives it (0.110: 0.005).
double half_of_last_digit(std::string_view text);
double half_of_last_digit(double size);

// Half a unit of the last digit of each number in the model file. Key: "table.key". Empty without a file.
std::map<std::string, double> written_errors(const std::filesystem::path& model);

// The same of the number that a set-up gives to `path`, through the conversion that was done: of a radius
// r = d / 2 or an area A = pi d^2 / 4 from a stated diameter d, dr = dd / 2 and dA = 2 A dd / d. 0: the
// set-up does not give it.
double written_error(const CampaignTrial& trial, std::string_view path);

}  // namespace sandhopper
