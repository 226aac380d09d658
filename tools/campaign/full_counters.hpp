#pragma once
#include <string>
#include <vector>

namespace sandhopper {

// Puts back the counts of a register of 12 to 32 bits that was full and began again: an encoder that turned
// past the end, or negative numbers of a converter that were written without their sign (16777178 for -38).
// Returns what was done, for a finding; empty if the numbers show no such register.
std::string put_register_back(std::vector<double>& counts);

}  // namespace sandhopper
