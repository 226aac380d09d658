#pragma once
#include <filesystem>
#include <string>

#include "tools/explain/explanation.hpp"

namespace sandhopper {

// One HTML page that holds all it shows and asks no network: the check that fired with value and limit, what
// was done, the cure, and plots of what was measured before and after.
std::string explanation_page(const Explanation& explanation);

// Throws std::runtime_error with path and cause where that fails.
void write_explanation_page(const Explanation& explanation, const std::filesystem::path& path);

}  // namespace sandhopper
