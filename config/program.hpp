#pragma once
#include <filesystem>
#include <string>

namespace sandhopper {

// Finds another program of this project: next to this one, in the bin folder of the same installation, or in
// its libexec/sandhopper. Throws std::runtime_error with the cure if it is in none of them.
std::filesystem::path find_program(const std::string& name);

}  // namespace sandhopper
